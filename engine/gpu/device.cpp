#include "gpu/device.h"

#include "platform/system.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace palpa {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                            VkDebugUtilsMessageTypeFlagsEXT /*type*/,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data,
                                            void* messages) {
    static_cast<std::vector<std::string>*>(messages)->emplace_back(data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(std::vector<std::string>& messages) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = keep_message;
    info.pUserData = &messages;
    return info;
}

bool has_validation_layer() {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, validation_layer) == 0;
    });
}

// A queue family that draws, and presents where there is a surface; if the device has one.
std::optional<std::uint32_t> find_graphics_family(VkPhysicalDevice device, VkSurfaceKHR surface) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (std::uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) continue;
        VkBool32 presents = VK_TRUE;
        if (surface != VK_NULL_HANDLE) {
            check_vulkan(vkGetPhysicalDeviceSurfaceSupportKHR(device, i, surface, &presents),
                         "vkGetPhysicalDeviceSurfaceSupportKHR");
        }
        if (presents == VK_TRUE) return i;
    }
    return std::nullopt;
}

int rank_of(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 4;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 3;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        default:
            return 1;
    }
}

}  // namespace

void check_vulkan(VkResult result, const char* call) {
    if (result == VK_SUCCESS) return;
    const std::string what =
        fmt::format("{} failed with Vulkan result {}", call, static_cast<int>(result));
    if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost(what);
    throw GpuError(what);
}

GpuDevice::GpuDevice() : messages_(std::make_unique<std::vector<std::string>>()) {}

GpuDevice::GpuDevice(const GpuOptions& options)
    : GpuDevice() {  // from here on the destructor runs, whatever is thrown
    options_ = options;
    create_instance();
    if (options.create_surface) surface_ = options.create_surface(instance_);
    choose_physical_device();
    create_device();
}

GpuDevice::~GpuDevice() {
    if (device_ != VK_NULL_HANDLE) {
        vkDeviceWaitIdle(device_);
        vkDestroyCommandPool(device_, pool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (surface_ != VK_NULL_HANDLE) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(instance_, messenger_, nullptr);
    }
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

std::uint32_t GpuDevice::find_memory_type(std::uint32_t allowed,
                                          VkMemoryPropertyFlags wanted) const noexcept {
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
        const bool is_allowed = (allowed & (1U << i)) != 0;
        if (is_allowed && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    }
    return UINT32_MAX;
}

void GpuDevice::submit(const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool_;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check_vulkan(vkAllocateCommandBuffers(device_, &allocate, &commands),
                 "vkAllocateCommandBuffers");

    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_vulkan(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    record(commands);
    check_vulkan(vkEndCommandBuffer(commands), "vkEndCommandBuffer");

    VkSubmitInfo submission{};
    submission.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submission.commandBufferCount = 1;
    submission.pCommandBuffers = &commands;
    const VkResult submitted = vkQueueSubmit(queue_, 1, &submission, VK_NULL_HANDLE);
    const VkResult waited = submitted == VK_SUCCESS ? vkQueueWaitIdle(queue_) : submitted;
    vkFreeCommandBuffers(device_, pool_, 1, &commands);
    check_vulkan(submitted, "vkQueueSubmit");
    check_vulkan(waited, "vkQueueWaitIdle");
}

void GpuDevice::create_instance() {
    if (!has_vulkan()) {
        throw GpuError(fmt::format("there is no Vulkan driver; {}", vulkan_remedy()));
    }
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "Palpa";
    application.apiVersion = VK_API_VERSION_1_1;

    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    std::vector<const char*> extensions = options_.instance_extensions;
    const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(*messages_);
    const VkValidationFeatureEnableEXT synchronisation =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    if (options_.validation) {
        if (!has_validation_layer()) throw GpuError("no Vulkan validation layer is installed");
        features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
        features.pNext = &messenger;  // for what happens while the instance is made
        features.enabledValidationFeatureCount = 1;
        features.pEnabledValidationFeatures = &synchronisation;
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &validation_layer;
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    }
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    if (vkCreateInstance(&info, nullptr, &instance_) != VK_SUCCESS) {
        throw GpuError(fmt::format("Vulkan cannot be started; {}", vulkan_remedy()));
    }
    if (!options_.validation) return;
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    check_vulkan(create(instance_, &messenger, nullptr, &messenger_),
                 "vkCreateDebugUtilsMessengerEXT");
}

void GpuDevice::choose_physical_device() {
    std::uint32_t count = 0;
    check_vulkan(vkEnumeratePhysicalDevices(instance_, &count, nullptr),
                 "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check_vulkan(vkEnumeratePhysicalDevices(instance_, &count, devices.data()),
                 "vkEnumeratePhysicalDevices");
    std::string refused;
    int best = 0;
    for (const VkPhysicalDevice device : devices) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        const std::optional<std::uint32_t> family = find_graphics_family(device, surface_);
        VkPhysicalDeviceFeatures features;
        vkGetPhysicalDeviceFeatures(device, &features);
        const bool is_new = properties.apiVersion >= VK_API_VERSION_1_1,
                   is_writing = features.fragmentStoresAndAtomics == VK_TRUE;
        if (!family || !is_new || !is_writing) {
            refused += fmt::format("; {}: {}", properties.deviceName,
                                   !family   ? "has no graphics queue"
                                   : !is_new ? "older than Vulkan 1.1"
                                             : "fragment shaders cannot write to buffers");
            continue;
        }
        if (rank_of(properties.deviceType) <= best) continue;
        best = rank_of(properties.deviceType);
        physical_ = device;
        properties_ = properties;
        queue_family_ = *family;
    }
    if (physical_ == VK_NULL_HANDLE) throw GpuError("no usable Vulkan device was found" + refused);
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
}

void GpuDevice::create_device() {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    VkPhysicalDeviceFeatures features{};
    features.fragmentStoresAndAtomics = VK_TRUE;  // lists of what is translucent
    info.pEnabledFeatures = &features;
    const char* const swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    if (surface_ != VK_NULL_HANDLE) {
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &swapchain;
    }
    check_vulkan(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);

    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = queue_family_;
    check_vulkan(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "vkCreateCommandPool");
}

}  // namespace palpa
