// The legend of the picture's colours.
#pragma once
#include "ui/layout.h"
#include "view/atom_colours.h"

#include <span>

namespace palpa {

// Describes the legend to the overlay library, in the lower left corner of `area`; nothing without
// entries. It does not take mouse input.
void draw_legend_panel(std::span<const LegendEntry> legend, const ScreenArea& area);

}  // namespace palpa
