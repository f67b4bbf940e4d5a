// What the colours of a whole view mean.
#pragma once
#include "ecs/world.h"
#include "view/atom_colours.h"
#include "view/build_frame.h"

#include <vector>

namespace palpa {

// The entries of every colouring that something in the view has: of everything, of molecules that
// have one of their own, of layers. None twice; in that order. Empty where colours are seen
// without.
std::vector<LegendEntry> find_legend(const World& world, const ViewSettings& settings);

}  // namespace palpa
