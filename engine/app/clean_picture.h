// Pictures of the state on screen without panels, drawn as `palpa render` draws them.
#pragma once
#include "ecs/world.h"
#include "render/picture.h"

#include <cstdint>
#include <string>

namespace palpa {

struct CleanPicture {
    std::uint32_t width = 1920, height = 1080;
    std::uint32_t samples = 4;  // averaged for each pixel: 1 or 4
    bool is_clear = false;      // without background
    bool has_words = true;      // labels and legend
    bool has_arrow = true;      // of the force on what is in hand
};

// Samples of a picture, in all.
inline constexpr std::uint64_t most_picture_samples = 128'000'000;

// Draws all that is seen between the panels; the picture may show more at its sides. Call it
// between two frames. `problem`, if wanted: why words are missing. Throws GpuError for a size that
// the device cannot draw.
Picture draw_clean_picture(World& app, const CleanPicture& wanted, std::string* problem = nullptr);

}  // namespace palpa
