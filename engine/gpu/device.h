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

// A Vulkan call failed, or no device is usable: a sentence for the user.
class GpuError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The device was lost with all its objects; a new GpuDevice may find it again.
class DeviceLost : public GpuError {
public:
    using GpuError::GpuError;
};

// Throws GpuError (or DeviceLost) with the name of the call unless the result is VK_SUCCESS.
void check_vulkan(VkResult result, const char* call);

struct GpuOptions {
    bool validation = false;     // with synchronisation validation; needs the Khronos layer
    bool force_staging = false;  // upload through staging buffers even where memory is shared

    // For a window: the instance extensions and the function that creates its surface. The device
    // can then present to it.
    std::vector<const char*> instance_extensions{};
    std::function<VkSurfaceKHR(VkInstance)> create_surface{};
};

// Owns instance, device, queue and command pool. Used by one thread.
class GpuDevice {
public:
    // Prefers a discrete GPU, then an integrated one, then software. Throws GpuError with the
    // reason for which each device was refused.
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

    // Messages of the validation layer so far; empty without validation, or without errors.
    const std::vector<std::string>& validation_messages() const noexcept { return *messages_; }

private:
    GpuDevice();

    void create_instance();
    void choose_physical_device();
    void create_device();

    GpuOptions options_;
    std::unique_ptr<std::vector<std::string>> messages_;  // the layer stores its address
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
