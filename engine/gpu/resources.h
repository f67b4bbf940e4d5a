// Vulkan buffers and images with their memory, released at the end of their scope.
#pragma once
#include "gpu/device.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace palpa {

// The kind of memory of a buffer.
enum class BufferPlace {
    Device,    // device memory, filled through an UploadBuffer
    Readback,  // host memory, for results of the device
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

    // The buffer's memory if the processor can access it, else an empty span.
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

    // Reserves this number of bytes, at least one element. Returns true if the buffer was replaced,
    // so that its content is lost.
    [[nodiscard]] bool reserve(VkDeviceSize bytes);

    // Where to write before `record` records what brings the first `bytes` to the device, for
    // shaders to read, and as vertices.
    std::span<std::byte> mapped() const noexcept;
    void record(VkCommandBuffer commands, VkDeviceSize bytes) const noexcept;

    VkBuffer handle() const noexcept { return target_.handle(); }

private:
    const GpuDevice* device_;
    VkBufferUsageFlags usage_;
    Buffer target_, staging_;  // no staging buffer if the target is mapped
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

// The images into which a render pass draws.
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
