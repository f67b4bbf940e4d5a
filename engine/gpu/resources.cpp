#include "gpu/resources.h"

#include <algorithm>

namespace palpa {
namespace {

constexpr VkMemoryPropertyFlags visible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

VkDeviceMemory allocate(const GpuDevice& device, const VkMemoryRequirements& needs,
                        std::uint32_t type) {
    if (type == UINT32_MAX) throw GpuError("the device has no memory of the kind that is needed");
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

Buffer upload(GpuDevice& device, std::span<const std::byte> content, VkBufferUsageFlags usage) {
    const VkDeviceSize bytes = std::max<VkDeviceSize>(content.size(), 64);
    Buffer target(device, bytes, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Device);
    if (!target.mapped().empty()) {
        std::copy(content.begin(), content.end(), target.mapped().begin());
        return target;
    }
    const Buffer staging(device, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::Readback);
    std::copy(content.begin(), content.end(), staging.mapped().begin());
    device.submit([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes};
        vkCmdCopyBuffer(commands, staging.handle(), target.handle(), 1, &region);
    });
    return target;
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
             VkImageAspectFlags aspect)
    : Image() {
    device_ = device.handle();
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
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
    view.format = format;
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

}  // namespace palpa
