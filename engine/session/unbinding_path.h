// How far what is in the hand went from where it started, and how it came back.
#pragma once
#include "ecs/world.h"
#include "math/vec.h"

#include <cstddef>
#include <vector>

namespace palpa {

// Å; heavy atoms are all but hydrogens.
struct UnbindingPath {
    double farthest = 0;   // of the centre of mass from its start
    double clearance = 0;  // then: between heavy atoms of it and of all other molecules
    double closest = 0;    // the smallest such distance of the whole way
    double last_rmsd = 0;  // of its heavy atoms at the end from their start
};

// Of a molecule that the hand moves in space, or of the residue or atom that its spring pulls at.
class UnbindingLog {
public:
    explicit UnbindingLog(const World& start);

    void add(const World& world);
    const UnbindingPath& unbinding() const noexcept { return unbinding_; }

private:
    std::vector<std::size_t> heavy_, other_heavy_;
    std::vector<Vec3> start_;  // of `heavy_`
    Vec3 start_centre_ = Vec3::Zero();
    UnbindingPath unbinding_;
};

}  // namespace palpa
