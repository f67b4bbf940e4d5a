// Frames with their words: pictures and films without a window, and clean pictures of a window.
#pragma once
#include "ecs/world.h"
#include "render/renderer.h"
#include "render/text.h"
#include "view/build_frame.h"
#include "view/picture_words.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// Nothing where words cannot be written; then one more warning says why.
std::optional<TextPainter> open_words(std::vector<std::string>& warnings);

struct WordedFrame {
    FrameScene scene;
    PictureWords words;
};
WordedFrame build_worded_frame(FrameBuilder& builder, const World& world, const ViewSettings& view);

// Pixels, and how many samples are averaged for each: 1, 4, 9 or 16.
struct PictureSize {
    std::uint32_t width = 0, height = 0, samples = 1;

    std::uint32_t side() const;  // samples either way
    VkExtent2D drawn() const { return {side() * width, side() * height}; }
};

// Draws the frame, its outline as wide as a pixel; and its words, where there is a painter, on the
// finished picture. `left_out`, if wanted: the words that found no room. Throws GpuError.
Picture draw_worded(Renderer& renderer, const PictureSize& size, WordedFrame& frame,
                    std::optional<TextPainter>& painter, LeftOutWords* left_out = nullptr);

}  // namespace palpa
