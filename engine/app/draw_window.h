// Draws a frame of the window: panels, then the picture in what they leave free.
#pragma once
#include "ecs/world.h"

namespace palpa {

// Describes the panels, draws and presents the picture, saves screenshots; then does what buttons
// and menus asked for. Throws GpuError.
void draw_window(World& app);

// True while the window has no size: nothing is drawn.
bool is_minimised(const World& app);

}  // namespace palpa
