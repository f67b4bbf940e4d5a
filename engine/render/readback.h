// Reads images of the device back to the host.
#pragma once
#include "gpu/device.h"
#include "gpu/resources.h"

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace palpa {

// Part of a colour image. The image is where it can be copied from.
class Readback {
public:
    Readback(const GpuDevice& device, VkExtent2D size, VkDeviceSize bytes_a_pixel)
        : size_(size),
          buffer_(device, bytes_a_pixel * size.width * size.height,
                  VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback) {}

    void record(VkCommandBuffer commands, VkImage image, VkOffset2D from) const;

    template <class Pixel>
    std::vector<Pixel> read() const {
        const std::span<std::byte> bytes = buffer_.mapped();
        std::vector<Pixel> pixels(bytes.size() / sizeof(Pixel));
        std::memcpy(pixels.data(), bytes.data(), bytes.size());
        return pixels;
    }

private:
    VkExtent2D size_;
    Buffer buffer_;
};

// The same for an image that shaders read before and after.
void record_between_reads(VkCommandBuffer commands, VkImage image, VkOffset2D from,
                          const Readback& readback);

}  // namespace palpa
