// Draws distances, angles and dihedrals between points with their values.
#pragma once
#include "math/vec.h"
#include "render/frame_scene.h"
#include "view/signs.h"

#include <span>
#include <vector>

namespace palpa {

// The mean position of the chosen atoms, without mass weights. `chosen` has one entry per atom, at
// least one of them true.
Vec3 find_centre(std::span<const Vec3> positions, const std::vector<bool>& chosen);

// Dashes between successive points. For two points the distance, "3.42 Å"; for three an arc about
// the second one, "104.5°"; for four an arc about the middle of the axis, "-57.0°" with the sign of
// find_dihedral. No arc for collinear points.
void add_measure(std::span<const Vec3> places, FrameScene& frame, std::vector<ViewLabel>& labels);

}  // namespace palpa
