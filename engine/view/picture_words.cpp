#include "view/picture_words.h"

#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace palpa {
namespace {

PixelBox grown(const PixelBox& box, int by) {
    return {box.left - by, box.top - by, box.right + by, box.bottom + by};
}

// A label's place in the picture.
struct SeenLabel {
    std::size_t label = 0;
    glm::vec3 place{0};  // pixels from the upper left, and Å from the camera
};

// The order in which they find room.
std::vector<SeenLabel> list_seen(std::span<const ViewLabel> labels, const FrameCamera& camera,
                                 std::uint32_t width, std::uint32_t height) {
    std::vector<SeenLabel> seen;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const glm::vec3 at = project(camera, labels[i].place, width, height);
        if (!(at.z > camera.near) || !(at.x >= 0 && at.x < static_cast<float>(width)) ||
            !(at.y >= 0 && at.y < static_cast<float>(height)))
            continue;
        seen.push_back({i, at});
    }
    std::ranges::stable_sort(seen, [&](const SeenLabel& a, const SeenLabel& b) {
        if (labels[a.label].is_tick != labels[b.label].is_tick) return labels[b.label].is_tick;
        return a.place.z < b.place.z;
    });
    return seen;
}

// Beside the place in one of eight directions: right and above first, where readers expect it.
constexpr std::array<std::array<float, 2>, 8> directions{
    {{1, -1}, {1, 1}, {-1, -1}, {-1, 1}, {1, 0}, {-1, 0}, {0, -1}, {0, 1}}};

PixelBox beside(const glm::vec3& place, const TextSize& size, const std::array<float, 2>& towards,
                float distance) {
    const float slant = towards[0] != 0 && towards[1] != 0 ? 0.7F : 1;
    const auto start = [&](float at, float direction, int extent) {
        const float shift = 0.5F * (direction - 1) * static_cast<float>(extent);
        return static_cast<int>(std::lround(at + direction * slant * distance + shift));
    };
    const int left = start(place.x, towards[0], size.width);
    // A line is higher than its letters, which may come nearer by so much.
    const float blank = 0.2F * static_cast<float>(size.height);
    const int top = start(place.y - towards[1] * blank, towards[1], size.height);
    return {left, top, left + size.width, top + size.height};
}

bool is_inside(const PixelBox& box, std::uint32_t width, std::uint32_t height) {
    return box.left >= 0 && box.top >= 0 && box.right <= static_cast<int>(width) &&
           box.bottom <= static_cast<int>(height);
}

struct LegendLayout {
    int letter_size = 0, line = 0, gap = 0;
    PixelBox box;
};

// Nothing where the picture has no room for it.
std::optional<LegendLayout> lay_out_legend(std::span<const LegendEntry> legend, int letter_size,
                                           const Picture& picture, TextPainter& painter) {
    LegendLayout layout{letter_size, 0, letter_size / 2, {}};
    int widest = 0;
    for (const LegendEntry& entry : legend) {
        const TextSize size = painter.measure(entry.text, letter_size);
        widest = std::max(widest, size.width);
        layout.line = std::max(layout.line, size.height);
    }
    const int bottom = static_cast<int>(picture.height) - letter_size;
    const int rows = static_cast<int>(legend.size()) * layout.line;
    layout.box = {letter_size, bottom - rows, letter_size + letter_size + layout.gap + widest,
                  bottom};
    const int rim = halo_width(letter_size);
    if (!is_inside(grown(layout.box, rim), picture.width, picture.height)) return std::nullopt;
    return layout;
}

void fill(Picture& picture, const PixelBox& box, const PixelColour& colour) {
    const PixelBox inside =
        common(box, {0, 0, static_cast<int>(picture.width), static_cast<int>(picture.height)});
    for (int y = inside.top; y < inside.bottom; ++y)
        for (int x = inside.left; x < inside.right; ++x) lay_over(picture, x, y, colour, 1);
}

void draw_legend(std::span<const LegendEntry> legend, const LegendLayout& layout,
                 const TextColours& colours, TextPainter& painter, Picture& picture) {
    const int edge = std::max(1, layout.letter_size / 16);
    for (std::size_t i = 0; i < legend.size(); ++i) {
        const int top = layout.box.top + static_cast<int>(i) * layout.line;
        const int side = layout.letter_size;
        const int square_top = top + (layout.line - side) / 2;
        const PixelBox square{layout.box.left, square_top, layout.box.left + side,
                              square_top + side};
        const glm::vec3& colour = legend[i].colour;
        fill(picture, square, colours.ink);
        fill(picture, grown(square, -edge),
             {srgb_code(colour.r), srgb_code(colour.g), srgb_code(colour.b)});
        painter.draw(picture, legend[i].text, square.right + layout.gap, top, layout.letter_size,
                     colours);
    }
}

}  // namespace

PlacedLabels place_labels(std::span<const ViewLabel> labels, std::span<const TextSize> sizes,
                          const FrameCamera& camera, LabelRoom room) {
    PlacedLabels found;
    const auto is_free = [&](const PixelBox& box) {
        return is_inside(box, room.width, room.height) &&
               std::ranges::all_of(room.taken, [&](const PixelBox& other) {
                   return common(box, grown(other, room.gap)).is_empty();
               });
    };
    const auto find_room = [&](const SeenLabel& seen) -> std::optional<PixelBox> {
        const TextSize& size = sizes[seen.label];
        for (const float distance : {0.4F, 1.2F}) {  // of the line's height
            for (const auto& towards : directions) {
                const PixelBox box =
                    beside(seen.place, size, towards, distance * static_cast<float>(size.height));
                if (is_free(box)) return box;
            }
        }
        return std::nullopt;
    };
    for (const SeenLabel& seen : list_seen(labels, camera, room.width, room.height)) {
        if (const std::optional<PixelBox> box = find_room(seen)) {
            room.taken.push_back(*box);
            found.placed.push_back({seen.label, *box});
        } else if (!labels[seen.label].is_tick) {
            ++found.unplaced;
        }
    }
    return found;
}

LeftOutWords write_words(const PictureWords& words, const FrameScene& frame, TextPainter& painter,
                         Picture& picture) {
    const int letter_size = text_size_for(picture.height);
    const TextColours colours = text_colours_on(frame.background);
    LeftOutWords left_out;
    LabelRoom room{picture.width, picture.height, halo_width(letter_size)};
    if (!words.legend.empty()) {
        const std::optional<LegendLayout> layout =
            lay_out_legend(words.legend, letter_size, picture, painter);
        left_out.has_legend = !layout;
        if (layout) {
            draw_legend(words.legend, *layout, colours, painter, picture);
            room.taken.push_back(layout->box);
        }
    }
    std::vector<TextSize> sizes;
    for (const ViewLabel& label : words.labels)
        sizes.push_back(painter.measure(label.text, letter_size));
    const PlacedLabels found = place_labels(words.labels, sizes, frame.camera, std::move(room));
    left_out.labels = found.unplaced;
    for (const PlacedLabel& label : found.placed)
        painter.draw(picture, words.labels[label.label].text, label.box.left, label.box.top,
                     letter_size, colours);
    return left_out;
}

}  // namespace palpa
