// Turns a system to a chosen orientation.
#pragma once
#include "math/vec.h"
#include "molecule/atoms.h"
#include "prepare/settings.h"

#include <span>
#include <string>

namespace palpa {

// Moves all positions, as one rigid body: the middle of the segment's atoms (heavier than hydrogen
// all alike) comes to the origin and its long axis along x, from the first of the other segments
// towards the last. y is the part across x of the way from one residue's CA, or first atom, to
// another's, each the mean over all chains where none is named; without the two, of the segment's
// second axis. Rounded to six decimals, far below what matters, so that every compiler writes the
// same file. Throws LoadError where a name means nothing or a direction is none.
void align(const Structure& structure, const AlignSettings& settings, std::span<Vec3> positions);

}  // namespace palpa
