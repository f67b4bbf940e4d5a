// Buffers and images with their memory; gone when they go out of scope.
#pragma once
#include "gpu/device.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace palpa {

// Where a buffer is written and read from.
enum class BufferPlace {
    Device,    // the device's own memory, filled through `upload`
    Readback,  // the processor's, for what the device hands back
};

class Buffer {
public:
    Buffer() = default;
    Buffer(const GpuDevice& device, VkDeviceSize bytes, VkBufferUsageFlags usage,
           BufferPlace place);
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Buffer();

    VkBuffer handle() const noexcept { return buffer_; }
    VkDeviceSize bytes() const noexcept { return bytes_; }

    // The buffer's memory where the processor sees it, or an empty span.
    std::span<std::byte> mapped() const noexcept {
        return {static_cast<std::byte*>(mapped_), mapped_ ? static_cast<std::size_t>(bytes_) : 0};
    }

private:
    void swap(Buffer& other) noexcept;

    VkDevice device_ = VK_NULL_HANDLE;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize bytes_ = 0;
    void* mapped_ = nullptr;
};

// Makes a device buffer with this content, directly where the processor can write it (and the
// device does not force staging), through a staging buffer otherwise. Never empty: one element at
// least.
Buffer upload(GpuDevice& device, std::span<const std::byte> content, VkBufferUsageFlags usage);

// What was copied so far in these commands may be read by the processor once they are done.
void show_copies_to_host(VkCommandBuffer commands) noexcept;

class Image {
public:
    Image() = default;
    Image(const GpuDevice& device, VkExtent2D size, VkFormat format, VkImageUsageFlags usage,
          VkImageAspectFlags aspect);
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Image();

    VkImage handle() const noexcept { return image_; }
    VkImageView view() const noexcept { return view_; }

private:
    void swap(Image& other) noexcept;

    VkDevice device_ = VK_NULL_HANDLE;
    VkImage image_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
};

}  // namespace palpa
