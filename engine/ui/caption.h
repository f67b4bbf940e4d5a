// Draws a large caption over the picture.
#pragma once
#include "ui/layout.h"

#include <string>

namespace palpa {

// Call between begin and end of the overlay library's frame. Drawn below all panels in the upper
// part of the area, smaller if the text is too wide.
void draw_caption(const std::string& text, const ScreenArea& area);

}  // namespace palpa
