// How far what is in the hand went from where it started, and how it came back.
#pragma once
#include "ecs/world.h"
#include "math/vec.h"
#include "session/compare_poses.h"

#include <cstddef>
#include <vector>

namespace palpa {

// Å; heavy atoms are all but hydrogens.
struct UnbindingPath {
    double farthest = 0;   // of the centre of mass from its start
    double clearance = 0;  // then: between heavy atoms of it and of all other molecules
    double closest = 0;    // the smallest such distance of the whole way
    // rms at the end from the start, as in session/compare_poses.h: of its heavy atoms, the
    // backbone of others, and side chains of the pocket.
    double last_rmsd = 0, last_backbone = 0, last_pocket = 0;
};

// Of a molecule that the hand moves in space, or of the residue or atom that its spring pulls at.
class UnbindingLog {
public:
    explicit UnbindingLog(const World& start);

    void add(const World& world);
    UnbindingPath unbinding() const;

private:
    std::vector<std::size_t> heavy_, other_heavy_;
    PoseComparison comparison_;
    std::vector<Vec3> start_, last_;  // of all atoms
    Vec3 start_centre_ = Vec3::Zero();
    UnbindingPath unbinding_;
};

}  // namespace palpa
