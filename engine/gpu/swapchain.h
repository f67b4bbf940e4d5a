// The swapchain of a window: acquires, paints, overlays and presents its images.
#pragma once
#include "gpu/device.h"
#include "gpu/resources.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace palpa {

// The pixels of the window, 4 bytes each (sRGB), rows from the top.
struct WindowShot {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

// Only one frame is in flight. The device must have a surface.
class Swapchain {
public:
    // `wanted`: the window's size in pixels, used if the surface leaves the choice.
    Swapchain(GpuDevice& device, VkExtent2D wanted);
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;
    ~Swapchain();

    VkExtent2D size() const noexcept { return size_; }
    std::uint32_t image_count() const noexcept {
        return static_cast<std::uint32_t>(images_.size());
    }
    // A classic pass with one colour attachment, over what was painted before.
    VkRenderPass overlay_pass() const noexcept { return pass_; }

    // Rebuilds it for another window size, or after `present` returned false.
    void rebuild(VkExtent2D wanted);

    // One frame: `paint` fills an image of the window's size, in TRANSFER_DST_OPTIMAL; `overlay`
    // draws over it inside of overlay_pass(). With `shot`, what is shown is kept there as well.
    // False where the window changed and the swapchain must be rebuilt; nothing need have been
    // drawn then.
    bool present(const std::function<void(VkCommandBuffer, VkImage)>& paint,
                 const std::function<void(VkCommandBuffer)>& overlay, WindowShot* shot = nullptr);

    // Waits until the last frame's commands are done, so that what they used may be written.
    void wait() const;

private:
    void create_pass();
    void create_images(VkExtent2D wanted, VkSwapchainKHR old);
    void destroy_images() noexcept;
    void record(std::uint32_t image, const std::function<void(VkCommandBuffer, VkImage)>& paint,
                const std::function<void(VkCommandBuffer)>& overlay, const Buffer* shot);

    struct Target {
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        VkSemaphore drawn = VK_NULL_HANDLE;  // signals that the image is ready to be presented
    };

    GpuDevice& device_;
    VkSurfaceFormatKHR format_{};
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D size_{};
    std::vector<Target> images_;
    VkSemaphore acquired_ = VK_NULL_HANDLE;
    VkFence done_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

}  // namespace palpa
