// The legend of a whole view.
#pragma once
#include "ecs/world.h"
#include "view/atom_colours.h"
#include "view/build_frame.h"

#include <vector>

namespace palpa {

// The entries of every colouring in use: of everything, of molecules with their own, of layers;
// each once, in this order. Empty if colours are self-evident.
std::vector<LegendEntry> find_legend(const World& world, const ViewSettings& settings);

}  // namespace palpa
