// Distances, angles and dihedrals between places, drawn and with their numbers beside them.
#pragma once
#include "math/vec.h"
#include "render/frame_scene.h"
#include "view/signs.h"

#include <span>
#include <vector>

namespace palpa {

// The mean of the places of the chosen atoms, not weighted by mass. `chosen` has one entry per
// atom, and at least one is true.
Vec3 find_centre(std::span<const Vec3> positions, const std::vector<bool>& chosen);

// Dashes from each place to the next. Of two their distance, "3.42 Å"; of three an arc about the
// second one, "104.5°"; of four an arc about the middle of the axis, from the side of the first to
// that of the last, "-57.0°" with the sign of find_dihedral. No arc where places are in line.
void add_measure(std::span<const Vec3> places, FrameScene& frame, std::vector<ViewLabel>& labels);

}  // namespace palpa
