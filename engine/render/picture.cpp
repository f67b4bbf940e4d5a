#include "render/picture.h"

#include "core/files.h"
#include "core/load_error.h"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace palpa {
namespace {

// sRGB (IEC 61966-2-1) to linear light and back.
float decode(std::uint8_t value) {
    const float encoded = static_cast<float>(value) / 255;
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

std::uint8_t encode(float light) {
    const float encoded =
        light <= 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

// Four bytes, the most significant first, as PNG has numbers.
std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
    return bytes;
}

// A chunk of text that says which program wrote the file; libpng's simple functions write none.
std::string software_chunk() {
    std::string checked = "tEXt";
    checked += picture_mark;
    const auto sum =
        crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    return big_endian(static_cast<std::uint32_t>(picture_mark.size())) + checked +
           big_endian(static_cast<std::uint32_t>(sum));
}

}  // namespace

PixelBox common(const PixelBox& a, const PixelBox& b) noexcept {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
            std::min(a.bottom, b.bottom)};
}

std::uint8_t srgb_code(float light) { return encode(std::clamp(light, 0.0F, 1.0F)); }

void lay_over(Picture& picture, int x, int y, const PixelColour& colour, float opacity) {
    if (!(opacity > 0)) return;
    std::uint8_t* const pixel =
        &picture
             .rgba[4 * (static_cast<std::size_t>(y) * picture.width + static_cast<std::size_t>(x))];
    const float behind = (1 - opacity) * static_cast<float>(pixel[3]) / 255;
    const float alpha = opacity + behind;
    for (std::size_t c = 0; c < 3; ++c) {
        const float mixed =
            opacity * static_cast<float>(colour[c]) + behind * static_cast<float>(pixel[c]);
        pixel[c] = static_cast<std::uint8_t>(std::lround(mixed / alpha));
    }
    pixel[3] = static_cast<std::uint8_t>(std::lround(255 * alpha));
}

void divide_by_alpha(Picture& picture) {
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        const std::uint8_t alpha = picture.rgba[i + 3];
        if (alpha == 255 || alpha == 0) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const float light = decode(picture.rgba[i + c]) * 255 / static_cast<float>(alpha);
            picture.rgba[i + c] = encode(std::min(light, 1.0F));
        }
    }
}

Picture average_down(const Picture& picture, std::uint32_t factor) {
    std::array<float, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = decode(static_cast<std::uint8_t>(i));
    const std::size_t parts = std::size_t{factor} * factor;
    Picture smaller{picture.width / factor, picture.height / factor, {}, {}, {}};
    for (std::size_t y = 0; y < smaller.height; ++y) {
        for (std::size_t x = 0; x < smaller.width; ++x) {
            std::array<float, 3> sum{};
            std::size_t alphas = 0;
            for (std::size_t part = 0; part < parts; ++part) {
                const std::size_t from =
                    (y * factor + part / factor) * picture.width + x * factor + part % factor;
                const std::uint8_t alpha = picture.rgba[4 * from + 3];
                alphas += alpha;
                for (std::size_t c = 0; c < 3; ++c) {
                    sum[c] += light[picture.rgba[4 * from + c]] * static_cast<float>(alpha);
                }
            }
            const auto weight = static_cast<float>(std::max<std::size_t>(alphas, 1));
            for (const float s : sum) smaller.rgba.push_back(encode(s / weight));
            smaller.rgba.push_back(static_cast<std::uint8_t>((alphas + parts / 2) / parts));
        }
    }
    return smaller;
}

Picture read_png(const std::filesystem::path& path) {
    constexpr png_uint_32 most = 4096;
    const std::string content = read_text_file(path);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, content.data(), content.size()) == 0)
        throw LoadError({path.string()}, std::string("is not a PNG file: ") + image.message);
    if (image.width > most || image.height > most) {
        png_image_free(&image);
        throw LoadError({path.string()},
                        fmt::format("has {}x{} pixels; expected at most {} either way", image.width,
                                    image.height, most));
    }
    image.format = PNG_FORMAT_RGBA;
    Picture picture{
        image.width, image.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image)), {}, {}};
    if (png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr) == 0)
        throw LoadError({path.string()}, std::string("cannot be read: ") + image.message);
    return picture;
}

void write_png(const std::filesystem::path& path, const Picture& picture, Existing existing) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width;
    image.height = picture.height;
    image.format = PNG_FORMAT_RGBA;
    image.flags = PNG_IMAGE_FLAG_FAST;
    png_alloc_size_t bytes = 0;
    std::string content;
    const bool sized =
        png_image_write_to_memory(&image, nullptr, &bytes, 0, picture.rgba.data(), 0, nullptr) != 0;
    content.resize(bytes);
    if (!sized || png_image_write_to_memory(&image, content.data(), &bytes, 0, picture.rgba.data(),
                                            0, nullptr) == 0) {
        throw LoadError({path.string()}, std::string("cannot be made: ") + image.message);
    }
    constexpr std::size_t header_end = 8 + 25;  // the signature and the chunk IHDR
    content.insert(header_end, software_chunk());
    write_text_file(path, content, existing);
}

}  // namespace palpa
