// Pictures in memory, and as PNG files.
#pragma once
#include "core/files.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace palpa {

// Rows from the top, pixels from the left.
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;    // 4 bytes a pixel, sRGB and alpha
    std::vector<std::uint32_t> picks;  // what is seen: a shape's `pick`, or nothing_seen
    std::vector<float> depth;          // Å in front of the camera; infinity where nothing is

    static constexpr std::uint32_t nothing_seen = UINT32_MAX;
};

// What is wanted of a picture: the colours cost the least.
enum class PictureContent { Colours, All };

// Colours that are times their alpha become what they are without it; where alpha is 0, black.
void divide_by_alpha(Picture& picture);

// The colours of a picture `factor` times smaller either way: each pixel is the mean light of
// factor x factor, weighted by alpha. The size must be a multiple.
Picture average_down(const Picture& picture, std::uint32_t factor);

// A PNG file's word for the program that wrote it, as it stands near the file's beginning.
inline constexpr std::string_view picture_mark{"Software\0Palpa", 14};

// Writes the colours as PNG, whole or not at all. Throws LoadError if it cannot.
void write_png(const std::filesystem::path& path, const Picture& picture,
               Existing existing = Existing::Refuse);

}  // namespace palpa
