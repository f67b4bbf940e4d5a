#include "gpu/resources.h"

#include <algorithm>

namespace palpa {
namespace {

constexpr VkMemoryPropertyFlags visible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

VkDeviceMemory allocate(const GpuDevice& device, const VkMemoryRequirements& needs,
                        std::uint32_t type) {
    if (type == UINT32_MAX)
        throw GpuError("the graphics device has no memory of the required type");
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check_vulkan(vkAllocateMemory(device.handle(), &info, nullptr, &memory), "vkAllocateMemory");
    return memory;
}

}  // namespace

Buffer::Buffer(const GpuDevice& device, VkDeviceSize bytes, VkBufferUsageFlags usage,
               BufferPlace place)
    : Buffer() {  // from here on the destructor runs, whatever is thrown
    device_ = device.handle();
    bytes_ = bytes;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = usage;
    check_vulkan(vkCreateBuffer(device_, &info, nullptr, &buffer_), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, buffer_, &needs);
    const VkMemoryPropertyFlags own = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    std::uint32_t type = UINT32_MAX;
    bool map = true;
    if (place == BufferPlace::Readback) {
        type = device.find_memory_type(needs.memoryTypeBits,
                                       visible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
        if (type == UINT32_MAX) type = device.find_memory_type(needs.memoryTypeBits, visible);
    } else {
        if (!device.force_staging()) {
            type = device.find_memory_type(needs.memoryTypeBits, own | visible);
        }
        map = type != UINT32_MAX;
        if (!map) type = device.find_memory_type(needs.memoryTypeBits, own);
    }
    memory_ = allocate(device, needs, type);
    check_vulkan(vkBindBufferMemory(device_, buffer_, memory_, 0), "vkBindBufferMemory");
    if (map) check_vulkan(vkMapMemory(device_, memory_, 0, bytes, 0, &mapped_), "vkMapMemory");
}

Buffer::~Buffer() {
    if (device_ == VK_NULL_HANDLE) return;
    vkDestroyBuffer(device_, buffer_, nullptr);
    vkFreeMemory(device_, memory_, nullptr);
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
}

bool UploadBuffer::reserve(VkDeviceSize bytes) {
    if (target_.handle() != VK_NULL_HANDLE && bytes <= target_.bytes()) return false;
    const VkDeviceSize room = std::max({bytes, 2 * target_.bytes(), VkDeviceSize{64}});
    target_ =
        Buffer(*device_, room, usage_ | VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Device);
    if (target_.mapped().empty()) {
        staging_ = Buffer(*device_, room, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::Readback);
    }
    return true;
}

std::span<std::byte> UploadBuffer::mapped() const noexcept {
    return target_.mapped().empty() ? staging_.mapped() : target_.mapped();
}

void UploadBuffer::record(VkCommandBuffer commands, VkDeviceSize bytes) const noexcept {
    if (!target_.mapped().empty() || bytes == 0) return;
    const VkBufferCopy region{0, 0, bytes};
    vkCmdCopyBuffer(commands, staging_.handle(), target_.handle(), 1, &region);
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         0, 1, &barrier, 0, nullptr, 0, nullptr);
}

void show_copies_to_host(VkCommandBuffer commands) noexcept {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &barrier, 0, nullptr, 0, nullptr);
}

Image::Image(const GpuDevice& device, VkExtent2D size, VkFormat format, VkImageUsageFlags usage,
             VkImageAspectFlags aspect, VkFormat view_format)
    : Image() {
    device_ = device.handle();
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    if (view_format == VK_FORMAT_UNDEFINED) view_format = format;
    if (view_format != format) info.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {size.width, size.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    check_vulkan(vkCreateImage(device_, &info, nullptr, &image_), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_, image_, &needs);
    memory_ = allocate(
        device, needs,
        device.find_memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT));
    check_vulkan(vkBindImageMemory(device_, image_, memory_, 0), "vkBindImageMemory");

    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = view_format;
    view.subresourceRange = {aspect, 0, 1, 0, 1};
    check_vulkan(vkCreateImageView(device_, &view, nullptr, &view_), "vkCreateImageView");
}

Image::~Image() {
    if (device_ == VK_NULL_HANDLE) return;
    vkDestroyImageView(device_, view_, nullptr);
    vkDestroyImage(device_, image_, nullptr);
    vkFreeMemory(device_, memory_, nullptr);
}

void Image::swap(Image& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(view_, other.view_);
    std::swap(memory_, other.memory_);
}

Framebuffer::Framebuffer(const GpuDevice& device, VkRenderPass pass,
                         std::span<const VkImageView> views, VkExtent2D size)
    : Framebuffer() {
    device_ = device.handle();
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pass;
    info.attachmentCount = static_cast<std::uint32_t>(views.size());
    info.pAttachments = views.data();
    info.width = size.width;
    info.height = size.height;
    info.layers = 1;
    check_vulkan(vkCreateFramebuffer(device_, &info, nullptr, &framebuffer_),
                 "vkCreateFramebuffer");
}

Framebuffer::~Framebuffer() {
    if (device_ != VK_NULL_HANDLE) vkDestroyFramebuffer(device_, framebuffer_, nullptr);
}

void Framebuffer::swap(Framebuffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(framebuffer_, other.framebuffer_);
}

}  // namespace palpa
