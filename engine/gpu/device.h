// A Vulkan device to draw with, into pictures or a window: instance, device, one queue.
#pragma once
#include <vulkan/vulkan.h>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpa {

// A Vulkan call that failed, or no device to call: a sentence for the user.
class GpuError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The device is gone, with all that was on it; a new GpuDevice may find it again.
class DeviceLost : public GpuError {
public:
    using GpuError::GpuError;
};

// Throws GpuError (DeviceLost where that is the reason), naming the call, unless the result is
// VK_SUCCESS.
void check_vulkan(VkResult result, const char* call);

struct GpuOptions {
    bool validation = false;     // with synchronisation validation; needs the Khronos layer
    bool force_staging = false;  // upload through staging buffers even where memory is shared

    // For a window: what its surface needs of the instance, and how it is made. The device then
    // can present to it.
    std::vector<const char*> instance_extensions{};
    std::function<VkSurfaceKHR(VkInstance)> create_surface{};
};

// Owns instance, device, queue and command pool. Used by one thread.
class GpuDevice {
public:
    // Takes a discrete GPU before an integrated one before software. Throws GpuError with the
    // reason each device was refused for.
    explicit GpuDevice(const GpuOptions& options);
    GpuDevice(const GpuDevice&) = delete;
    GpuDevice& operator=(const GpuDevice&) = delete;
    ~GpuDevice();

    VkInstance instance() const noexcept { return instance_; }
    VkDevice handle() const noexcept { return device_; }
    VkQueue queue() const noexcept { return queue_; }
    std::uint32_t queue_family() const noexcept { return queue_family_; }
    VkSurfaceKHR surface() const noexcept { return surface_; }  // null without a window
    VkPhysicalDevice physical() const noexcept { return physical_; }
    const VkPhysicalDeviceLimits& limits() const noexcept { return properties_.limits; }
    std::string name() const { return properties_.deviceName; }
    bool force_staging() const noexcept { return options_.force_staging; }

    // The index of a memory type among `allowed` (a bit mask) that has all `wanted` properties, or
    // UINT32_MAX.
    std::uint32_t find_memory_type(std::uint32_t allowed,
                                   VkMemoryPropertyFlags wanted) const noexcept;

    // Records commands, submits them, and waits until they are done.
    void submit(const std::function<void(VkCommandBuffer)>& record);

    // What the validation layer had to say so far; empty without validation, or without mistakes.
    const std::vector<std::string>& validation_messages() const noexcept { return *messages_; }

private:
    GpuDevice();

    void create_instance();
    void choose_physical_device();
    void create_device();

    GpuOptions options_;
    std::unique_ptr<std::vector<std::string>> messages_;  // the layer keeps its address
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties_{};
    VkPhysicalDeviceMemoryProperties memory_{};
    std::uint32_t queue_family_ = 0;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
};

}  // namespace palpa
