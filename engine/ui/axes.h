// Draws the directions of x, y and z over the picture.
#pragma once
#include "ui/layout.h"
#include "view/orbit_camera.h"

namespace palpa {

// Call between begin and end of the overlay library's frame. Draws below all panels, in the upper
// right corner of the area.
void draw_axes(const OrbitCamera& camera, const ScreenArea& area);

}  // namespace palpa
