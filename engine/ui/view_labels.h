// The words beside things in the picture.
#pragma once
#include "render/frame_scene.h"
#include "view/signs.h"

#include <span>

namespace palpa {

// Between begin and end of the overlay library's frame, under all panels, each below its place, and
// farther down where another is. A tick is left out where it would cover another label.
void draw_view_labels(std::span<const ViewLabel> labels, const FrameCamera& camera);

}  // namespace palpa
