// Pictures in device memory, ready to be copied into an image of a window.
#pragma once
#include "gpu/device.h"
#include "gpu/resources.h"
#include "render/picture.h"

#include <array>
#include <cstddef>
#include <span>

namespace palpa {

inline constexpr std::size_t most_sheet_pictures = 100;  // of 400 by 250 pixels

class PictureSheet {
public:
    // All of the same size, at most 4096 pixels either way together in rows of several. Throws
    // GpuError.
    PictureSheet(GpuDevice& device, std::span<const Picture> pictures);

    std::size_t size() const noexcept { return count_; }

    // Copies a picture, stretched to `to`, into the image (TRANSFER_DST_OPTIMAL); what of it is
    // outside of `within` is left as it was. Both in pixels; `within` lies inside of the image.
    void record(VkCommandBuffer commands, std::size_t number, VkImage image, const PixelBox& to,
                const PixelBox& within) const;

private:
    VkExtent2D each_;  // pixels
    std::size_t count_;
    std::uint32_t columns_ = 1;
    Image image_;  // all pictures side by side in rows
};

}  // namespace palpa
