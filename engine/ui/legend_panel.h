// What the picture's colours mean, in a corner of it.
#pragma once
#include "ui/layout.h"
#include "view/atom_colours.h"

#include <span>

namespace palpa {

// Describes it to the overlay library, in the lower left corner of `area`; nothing where there are
// no entries. The mouse goes through it.
void draw_legend_panel(std::span<const LegendEntry> legend, const ScreenArea& area);

}  // namespace palpa
