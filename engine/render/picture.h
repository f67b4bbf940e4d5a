// Pictures in memory, and as PNG files.
#pragma once
#include "core/files.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace palpa {

// Rows from the top, pixels from the left.
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;    // 4 bytes a pixel, sRGB and alpha
    std::vector<std::uint32_t> picks;  // visible shape's `pick`, or nothing_seen
    std::vector<float> depth;          // depth in front of the camera, Å; infinity for nothing

    static constexpr std::uint32_t nothing_seen = UINT32_MAX;
};

// A rectangle of a picture's pixels, without those at `right` and `bottom`.
struct PixelBox {
    int left = 0, top = 0, right = 0, bottom = 0;

    int width() const noexcept { return right - left; }
    int height() const noexcept { return bottom - top; }
    bool is_empty() const noexcept { return width() <= 0 || height() <= 0; }
    bool contains(int x, int y) const noexcept {
        return x >= left && x < right && y >= top && y < bottom;
    }
};
PixelBox common(const PixelBox& a, const PixelBox& b) noexcept;

using PixelColour = std::array<std::uint8_t, 3>;  // sRGB

// sRGB of linear light from 0 to 1; beyond, of the nearer end.
std::uint8_t srgb_code(float light);

// Colour over one pixel of the picture, `opacity` from 0 to 1, mixed as sRGB, as programs that draw
// letters do. What is clear gets as opaque as that.
void lay_over(Picture& picture, int x, int y, const PixelColour& colour, float opacity);

// The requested content of a picture; colours cost the least.
enum class PictureContent { Colours, All };

// Colours that are times their alpha become what they are without it; where alpha is 0, black.
void divide_by_alpha(Picture& picture);

// The colours of a picture `factor` times smaller either way: each pixel is the mean light of
// factor x factor, weighted by alpha. The size must be a multiple.
Picture average_down(const Picture& picture, std::uint32_t factor);

// Reads a PNG file's colours. Throws LoadError that names it; more than 4096 pixels either way are
// refused.
Picture read_png(const std::filesystem::path& path);

// A PNG file's word for the program that wrote it, as it stands near the file's beginning.
inline constexpr std::string_view picture_mark{"Software\0Palpa", 14};

// Writes the colours as PNG, whole or not at all. Throws LoadError if it cannot.
void write_png(const std::filesystem::path& path, const Picture& picture,
               Existing existing = Existing::Refuse);

}  // namespace palpa
