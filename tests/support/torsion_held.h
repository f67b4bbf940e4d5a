// Which joints and bases of made-up molecules may move, and how far an assembly's accelerations are
// from those of an oracle.
#pragma once
#include "assembly/passes.h"
#include "tests/support/torsion_oracles.h"

#include <cstdint>
#include <vector>

namespace palpa::test {

Held all_free(const TorsionCase& c);

// Some joints and bases at rest, some bases fixed and some guided, as wholes or at a point.
Held some_held(const TorsionCase& c, std::uint32_t seed, double share);

double rms_of(const std::vector<double>& values);

// Largest difference of an acceleration, against the rms of the joints' or the molecule's base's
// own; where nothing moves, against 1/AKMA^2, which the forces would cause.
double worst_difference(const AssemblyState& state, const TorsionAccelerations& expected);

}  // namespace palpa::test
