// Pictures that are brought back, whole or tile by tile.
#include "render/gpu_frame.h"
#include "render/readback.h"
#include "render/renderer.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace palpa {
namespace {

// How far shaders look around a pixel, beside outlines: see openness() in resolve.frag.
constexpr std::uint32_t farthest_tap = 64;

// Bytes a pixel of the layers' lists that draw() counts on: its head, and six layers.
constexpr VkDeviceSize layer_bytes = 4 + 6 * 12;

VkRect2D grow(const VkRect2D& part, std::uint32_t margin, VkExtent2D picture) {
    const auto begin = [&](std::int32_t at) {
        return std::max(at - static_cast<std::int32_t>(margin), 0);
    };
    const VkOffset2D from{begin(part.offset.x), begin(part.offset.y)};
    const auto size = [&](std::int32_t at, std::uint32_t extent, std::int32_t start,
                          std::uint32_t whole) {
        const std::uint32_t end = static_cast<std::uint32_t>(at) + extent + margin;
        return std::min(end, whole) - static_cast<std::uint32_t>(start);
    };
    return {from,
            {size(part.offset.x, part.extent.width, from.x, picture.width),
             size(part.offset.y, part.extent.height, from.y, picture.height)}};
}

// The part of the tile `drawn` that is `kept`.
template <class Pixel>
void paste(const std::vector<Pixel>& from, const VkRect2D& drawn, const VkRect2D& kept,
           std::size_t width, std::size_t parts, std::vector<Pixel>& to) {
    if (from.empty()) return;
    for (std::uint32_t row = 0; row < kept.extent.height; ++row) {
        const std::size_t y = static_cast<std::size_t>(kept.offset.y) + row;
        const std::size_t source =
            (y - static_cast<std::size_t>(drawn.offset.y)) * drawn.extent.width +
            static_cast<std::size_t>(kept.offset.x - drawn.offset.x);
        const std::size_t target = y * width + static_cast<std::size_t>(kept.offset.x);
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(parts * source),
                    parts * kept.extent.width,
                    to.begin() + static_cast<std::ptrdiff_t>(parts * target));
    }
}

}  // namespace

Picture Renderer::draw(const FrameScene& scene, std::uint32_t width, std::uint32_t height,
                       PictureContent content) {
    const VkPhysicalDeviceLimits& limits = device_.limits();
    std::uint32_t largest = limits.maxImageDimension2D;
    const bool has_layers = std::ranges::any_of(
        scene.meshes, [](const MeshShape& mesh) { return mesh.opacity > 0 && mesh.opacity < 1; });
    if (has_layers && layer_bytes * width * height > limits.maxStorageBufferRange) {
        largest = std::min(largest, static_cast<std::uint32_t>(
                                        std::sqrt(limits.maxStorageBufferRange / layer_bytes)));
    }
    return draw_in_tiles(scene, width, height, largest, content);
}

Picture Renderer::draw_in_tiles(const FrameScene& scene, std::uint32_t width, std::uint32_t height,
                                std::uint32_t largest, PictureContent content) {
    if (width == 0 || height == 0) {
        throw GpuError(
            fmt::format("a picture of {}x{} pixels; expected at least 1x1", width, height));
    }
    const GpuFrame whole = build_frame_constants(scene, {width, height});
    if (width <= largest && height <= largest) return draw_frame(scene, whole, content);
    const std::uint32_t margin =
        std::max(farthest_tap, static_cast<std::uint32_t>(std::max(scene.outline, 0))) + 1;
    if (largest <= 2 * margin) {
        throw GpuError(
            fmt::format("tiles of {} pixels are too small; expected more than {} pixels, the range "
                        "of shading and outlines",
                        largest, 2 * margin));
    }
    Picture picture{width, height, {}, {}, {}};
    const std::size_t pixels = std::size_t{width} * height;
    picture.rgba.resize(4 * pixels);
    if (content == PictureContent::All) {
        picture.picks.resize(pixels);
        picture.depth.resize(pixels);
    }
    const std::uint32_t step = largest - 2 * margin;
    for (std::uint32_t y = 0; y < height; y += step) {
        for (std::uint32_t x = 0; x < width; x += step) {
            const VkRect2D kept{{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                                {std::min(step, width - x), std::min(step, height - y)}};
            const VkRect2D drawn = grow(kept, margin, {width, height});
            const Picture tile = draw_frame(scene, crop_frame(whole, drawn), content);
            paste(tile.rgba, drawn, kept, width, 4, picture.rgba);
            paste(tile.picks, drawn, kept, width, 1, picture.picks);
            paste(tile.depth, drawn, kept, width, 1, picture.depth);
        }
    }
    return picture;
}

Picture Renderer::draw_frame(const FrameScene& scene, const GpuFrame& frame,
                             PictureContent content) {
    const VkExtent2D size = size_of(frame);
    check_size(size);
    const Readback colours(device_, size, 4);
    std::optional<Readback> seen;
    if (content == PictureContent::All) seen.emplace(device_, size, sizeof(Seen));
    const auto submit = [&] {
        device_.submit([&](VkCommandBuffer commands) {
            record_frame(commands, scene, frame);
            colours.record(commands, colour_.handle(), {0, 0});
            if (seen) record_between_reads(commands, view_.seen().handle(), {0, 0}, *seen);
            show_copies_to_host(commands);
        });
    };
    submit();
    if (lacks_layers()) submit();  // now there is room for them
    if (lacks_layers()) {
        throw GpuError(
            fmt::format("a picture of {}x{} pixels needs more than {} translucent layers, too many "
                        "for {}; expected a smaller picture",
                        size.width, size.height, layers_.room(), device_.name()));
    }
    Picture picture{size.width, size.height, colours.read<std::uint8_t>(), {}, {}};
    if (scene.clear_background) divide_by_alpha(picture);
    if (!seen) return picture;
    for (const Seen& pixel : seen->read<Seen>()) {
        picture.picks.push_back(pick_of(pixel.id));
        picture.depth.push_back(pixel.id == 0 ? std::numeric_limits<float>::infinity()
                                              : pixel.distance);
    }
    return picture;
}

bool Renderer::lacks_layers() const noexcept {
    return view_.meshes().has_translucent() && layers_.had_too_little_room();
}

std::uint32_t Renderer::pick(std::uint32_t x, std::uint32_t y) {
    if (x >= view_.size().width || y >= view_.size().height) return Picture::nothing_seen;
    const Readback readback(device_, {1, 1}, sizeof(Seen));
    device_.submit([&](VkCommandBuffer commands) {
        record_between_reads(commands, view_.seen().handle(),
                             {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                             readback);
        show_copies_to_host(commands);
    });
    return pick_of(readback.read<Seen>().front().id);
}

std::uint32_t Renderer::pick_of(std::uint32_t id) const noexcept {
    return id == 0 ? Picture::nothing_seen : picks_[id - 1];
}

}  // namespace palpa
