// A few large words over the picture.
#pragma once
#include "ui/layout.h"

#include <string>

namespace palpa {

// Between begin and end of the overlay library's frame, under all panels, in the upper part of the
// area. Where the words are wider than that they are smaller.
void draw_caption(const std::string& text, const ScreenArea& area);

}  // namespace palpa
