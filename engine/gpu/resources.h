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
    Device,    // the device's own memory, filled through an UploadBuffer
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

// A device buffer that is filled anew for every frame, and grows with what it holds. Written
// straight where the processor sees the device's memory (and the device does not force staging),
// through a staging buffer otherwise. Write it only while no commands that read it are under way.
class UploadBuffer {
public:
    UploadBuffer(const GpuDevice& device, VkBufferUsageFlags usage)
        : device_(&device), usage_(usage) {}

    // Makes room for that many bytes, one element's at least. What the buffer held is lost where
    // this returns true: then it is another one.
    [[nodiscard]] bool reserve(VkDeviceSize bytes);

    // Where to write before `record` records what brings the first `bytes` to the device, for
    // shaders to read, and as vertices.
    std::span<std::byte> mapped() const noexcept;
    void record(VkCommandBuffer commands, VkDeviceSize bytes) const noexcept;

    VkBuffer handle() const noexcept { return target_.handle(); }

private:
    const GpuDevice* device_;
    VkBufferUsageFlags usage_;
    Buffer target_, staging_;  // no staging buffer where the target is mapped
};

// What was copied so far in these commands may be read by the processor once they are done.
void show_copies_to_host(VkCommandBuffer commands) noexcept;

class Image {
public:
    Image() = default;
    // The view has the image's format unless it is given another.
    Image(const GpuDevice& device, VkExtent2D size, VkFormat format, VkImageUsageFlags usage,
          VkImageAspectFlags aspect, VkFormat view_format = VK_FORMAT_UNDEFINED);
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

// Images that a render pass draws into.
class Framebuffer {
public:
    Framebuffer() = default;
    Framebuffer(const GpuDevice& device, VkRenderPass pass, std::span<const VkImageView> views,
                VkExtent2D size);
    Framebuffer(Framebuffer&& other) noexcept { swap(other); }
    Framebuffer& operator=(Framebuffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Framebuffer();

    VkFramebuffer handle() const noexcept { return framebuffer_; }

private:
    void swap(Framebuffer& other) noexcept;

    VkDevice device_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

}  // namespace palpa
