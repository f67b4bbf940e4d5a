// Pictures of the state on screen without panels, drawn as `palpa render` draws them.
#pragma once
#include "ecs/world.h"
#include "render/picture.h"

#include <cstdint>

namespace palpa {

struct CleanPicture {
    std::uint32_t width = 1920, height = 1080;
    std::uint32_t samples = 4;  // averaged for each pixel: 1 or 4
    bool is_clear = false;      // without background
    bool has_words = true;      // labels and legend
    bool has_arrow = true;      // of the force on what is in hand
};

// Draws all that is seen between the panels; the picture may show more at its sides. Between
// two frames. Throws GpuError for a size that the device cannot draw.
Picture draw_clean_picture(World& app, const CleanPicture& wanted);

}  // namespace palpa
