#include "gpu/swapchain.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>

namespace palpa {
namespace {

constexpr std::uint64_t forever = std::numeric_limits<std::uint64_t>::max();

// Eight bits a channel that are taken as they are: pictures and overlays come in sRGB already.
VkSurfaceFormatKHR choose_format(const GpuDevice& device) {
    std::uint32_t count = 0;
    check_vulkan(
        vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), device.surface(), &count, nullptr),
        "vkGetPhysicalDeviceSurfaceFormatsKHR");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check_vulkan(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), device.surface(), &count,
                                                      formats.data()),
                 "vkGetPhysicalDeviceSurfaceFormatsKHR");
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
        for (const VkSurfaceFormatKHR& format : formats) {
            if (format.format == wanted) return format;
        }
    }
    throw GpuError("this display does not support 8 bits per colour channel");
}

VkImageMemoryBarrier barrier_of(VkImage image, VkImageLayout from, VkImageLayout to,
                                VkAccessFlags before, VkAccessFlags after) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.srcAccessMask = before;
    barrier.dstAccessMask = after;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    return barrier;
}

void change_layout(VkCommandBuffer commands, const VkImageMemoryBarrier& barrier,
                   VkPipelineStageFlags before, VkPipelineStageFlags after) {
    vkCmdPipelineBarrier(commands, before, after, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

WindowShot take_shot(const Buffer& buffer, VkExtent2D size, VkFormat format) {
    WindowShot shot{size.width, size.height, {}};
    shot.rgba.resize(std::size_t{4} * size.width * size.height);
    std::memcpy(shot.rgba.data(), buffer.mapped().data(), shot.rgba.size());
    for (std::size_t i = 0; i < shot.rgba.size(); i += 4) {
        if (format == VK_FORMAT_B8G8R8A8_UNORM) std::swap(shot.rgba[i], shot.rgba[i + 2]);
        shot.rgba[i + 3] = 255;
    }
    return shot;
}

}  // namespace

Swapchain::Swapchain(GpuDevice& device, VkExtent2D wanted)
    : device_(device), format_(choose_format(device)) {
    const VkDevice handle = device.handle();
    create_pass();
    VkSemaphoreCreateInfo semaphore{};
    semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    check_vulkan(vkCreateSemaphore(handle, &semaphore, nullptr, &acquired_), "vkCreateSemaphore");
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    check_vulkan(vkCreateFence(handle, &fence, nullptr, &done_), "vkCreateFence");
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = device.queue_family();
    check_vulkan(vkCreateCommandPool(handle, &pool, nullptr, &pool_), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool_;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check_vulkan(vkAllocateCommandBuffers(handle, &allocate, &commands_),
                 "vkAllocateCommandBuffers");
    create_images(wanted, VK_NULL_HANDLE);
}

Swapchain::~Swapchain() {
    const VkDevice handle = device_.handle();
    vkDeviceWaitIdle(handle);
    destroy_images();
    vkDestroySwapchainKHR(handle, swapchain_, nullptr);
    vkDestroyCommandPool(handle, pool_, nullptr);
    vkDestroyFence(handle, done_, nullptr);
    vkDestroySemaphore(handle, acquired_, nullptr);
    vkDestroyRenderPass(handle, pass_, nullptr);
}

void Swapchain::create_pass() {
    VkAttachmentDescription attachment{};
    attachment.format = format_.format;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    attachment.initialLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    attachment.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &colour;
    // The overlay waits for the picture, a copy of both waits for the overlay.
    std::array<VkSubpassDependency, 2> dependencies{};
    dependencies[0].srcSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[0].srcStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[0].srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    dependencies[0].dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[0].dstAccessMask =
        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstSubpass = VK_SUBPASS_EXTERNAL;
    dependencies[1].srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    dependencies[1].srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    dependencies[1].dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT;
    dependencies[1].dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 1;
    info.pAttachments = &attachment;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = static_cast<std::uint32_t>(dependencies.size());
    info.pDependencies = dependencies.data();
    check_vulkan(vkCreateRenderPass(device_.handle(), &info, nullptr, &pass_),
                 "vkCreateRenderPass");
}

void Swapchain::create_images(VkExtent2D wanted, VkSwapchainKHR old) {
    const VkDevice handle = device_.handle();
    VkSurfaceCapabilitiesKHR can;
    check_vulkan(
        vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), device_.surface(), &can),
        "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    size_ = can.currentExtent;
    if (size_.width == UINT32_MAX) {
        size_.width = std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width);
        size_.height =
            std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height);
    }
    const std::uint32_t most = device_.limits().maxImageDimension2D;
    if (size_.width == 0 || size_.height == 0) {  // folded away: nothing can be shown
        vkDestroySwapchainKHR(handle, old, nullptr);
        swapchain_ = VK_NULL_HANDLE;
        return;
    }
    if (size_.width > most || size_.height > most) {
        throw GpuError(fmt::format("a window of {}x{}; expected 1x1 to {}x{} on {}", size_.width,
                                   size_.height, most, most, device_.name()));
    }
    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = device_.surface();
    info.minImageCount = can.minImageCount + 1;
    if (can.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = size_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                      VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    if ((can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) == 0) {
        info.compositeAlpha = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    }
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;  // always there; does not throttle everywhere
    info.clipped = VK_TRUE;
    info.oldSwapchain = old;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    const VkResult result = vkCreateSwapchainKHR(handle, &info, nullptr, &made);
    vkDestroySwapchainKHR(handle, old, nullptr);
    swapchain_ = made;
    check_vulkan(result, "vkCreateSwapchainKHR");

    std::uint32_t count = 0;
    check_vulkan(vkGetSwapchainImagesKHR(handle, swapchain_, &count, nullptr),
                 "vkGetSwapchainImagesKHR");
    std::vector<VkImage> images(count);
    check_vulkan(vkGetSwapchainImagesKHR(handle, swapchain_, &count, images.data()),
                 "vkGetSwapchainImagesKHR");
    for (const VkImage image : images) {
        Target& target = images_.emplace_back();
        target.image = image;
        VkImageViewCreateInfo view{};
        view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format_.format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        check_vulkan(vkCreateImageView(handle, &view, nullptr, &target.view), "vkCreateImageView");
        VkFramebufferCreateInfo framebuffer{};
        framebuffer.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
        framebuffer.renderPass = pass_;
        framebuffer.attachmentCount = 1;
        framebuffer.pAttachments = &target.view;
        framebuffer.width = size_.width;
        framebuffer.height = size_.height;
        framebuffer.layers = 1;
        check_vulkan(vkCreateFramebuffer(handle, &framebuffer, nullptr, &target.framebuffer),
                     "vkCreateFramebuffer");
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        check_vulkan(vkCreateSemaphore(handle, &semaphore, nullptr, &target.drawn),
                     "vkCreateSemaphore");
    }
}

void Swapchain::destroy_images() noexcept {
    const VkDevice handle = device_.handle();
    for (const Target& target : images_) {
        vkDestroySemaphore(handle, target.drawn, nullptr);
        vkDestroyFramebuffer(handle, target.framebuffer, nullptr);
        vkDestroyImageView(handle, target.view, nullptr);
    }
    images_.clear();
}

void Swapchain::rebuild(VkExtent2D wanted) {
    check_vulkan(vkDeviceWaitIdle(device_.handle()), "vkDeviceWaitIdle");
    destroy_images();
    create_images(wanted, swapchain_);
}

void Swapchain::wait() const {
    check_vulkan(vkWaitForFences(device_.handle(), 1, &done_, VK_TRUE, forever), "vkWaitForFences");
}

bool Swapchain::present(const std::function<void(VkCommandBuffer, VkImage)>& paint,
                        const std::function<void(VkCommandBuffer)>& overlay, WindowShot* shot) {
    if (swapchain_ == VK_NULL_HANDLE) return false;
    wait();
    std::uint32_t image = 0;
    const VkResult acquired = vkAcquireNextImageKHR(device_.handle(), swapchain_, forever,
                                                    acquired_, VK_NULL_HANDLE, &image);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) return false;
    if (acquired != VK_SUBOPTIMAL_KHR) check_vulkan(acquired, "vkAcquireNextImageKHR");

    Buffer copy;
    if (shot) {
        copy = Buffer(device_, VkDeviceSize{4} * size_.width * size_.height,
                      VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback);
    }
    record(image, paint, overlay, shot ? &copy : nullptr);

    check_vulkan(vkResetFences(device_.handle(), 1, &done_), "vkResetFences");
    const VkPipelineStageFlags first_use = VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkSubmitInfo submission{};
    submission.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submission.waitSemaphoreCount = 1;
    submission.pWaitSemaphores = &acquired_;
    submission.pWaitDstStageMask = &first_use;
    submission.commandBufferCount = 1;
    submission.pCommandBuffers = &commands_;
    submission.signalSemaphoreCount = 1;
    submission.pSignalSemaphores = &images_[image].drawn;
    check_vulkan(vkQueueSubmit(device_.queue(), 1, &submission, done_), "vkQueueSubmit");

    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &images_[image].drawn;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_;
    info.pImageIndices = &image;
    const VkResult presented = vkQueuePresentKHR(device_.queue(), &info);
    if (shot) {
        wait();
        *shot = take_shot(copy, size_, format_.format);
    }
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR) return false;
    check_vulkan(presented, "vkQueuePresentKHR");
    return acquired == VK_SUCCESS;
}

void Swapchain::record(std::uint32_t index,
                       const std::function<void(VkCommandBuffer, VkImage)>& paint,
                       const std::function<void(VkCommandBuffer)>& overlay, const Buffer* shot) {
    const Target& target = images_[index];
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_vulkan(vkBeginCommandBuffer(commands_, &begin), "vkBeginCommandBuffer");
    change_layout(commands_,
                  barrier_of(target.image, VK_IMAGE_LAYOUT_UNDEFINED,
                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0, VK_ACCESS_TRANSFER_WRITE_BIT),
                  VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT);
    paint(commands_, target.image);

    VkRenderPassBeginInfo pass{};
    pass.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    pass.renderPass = pass_;
    pass.framebuffer = target.framebuffer;
    pass.renderArea.extent = size_;
    vkCmdBeginRenderPass(commands_, &pass, VK_SUBPASS_CONTENTS_INLINE);
    overlay(commands_);
    vkCmdEndRenderPass(commands_);

    if (shot) {
        change_layout(commands_,
                      barrier_of(target.image, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                 VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT),
                      VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                      VK_PIPELINE_STAGE_TRANSFER_BIT);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {size_.width, size_.height, 1};
        vkCmdCopyImageToBuffer(commands_, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               shot->handle(), 1, &region);
        show_copies_to_host(commands_);
        change_layout(commands_,
                      barrier_of(target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                 VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_ACCESS_TRANSFER_READ_BIT, 0),
                      VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT);
    }
    check_vulkan(vkEndCommandBuffer(commands_), "vkEndCommandBuffer");
}

}  // namespace palpa
