// Draws the labels in the picture.
#pragma once
#include "render/frame_scene.h"
#include "view/signs.h"

#include <span>

namespace palpa {

// Call between begin and end of the overlay library's frame. Drawn below all panels; each label
// below its point, farther down if another is in the way. A tick is omitted if it would cover
// another label.
void draw_view_labels(std::span<const ViewLabel> labels, const FrameCamera& camera);

}  // namespace palpa
