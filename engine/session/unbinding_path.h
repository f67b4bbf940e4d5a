// Measures how far the held molecule moved from its start, and how it returned.
#pragma once
#include "ecs/world.h"
#include "math/vec.h"
#include "session/compare_poses.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace palpa {

inline constexpr double free_angstrom = 4;

// Å. Heavy atoms are all atoms except hydrogens.
struct UnbindingPath {
    double farthest = 0;  // largest distance of the centre of mass from its start
    double clearance =
        0;  // at that time: shortest distance of its heavy atoms to those of all other molecules
    // Time at which it was first free: no heavy atom of others within `free_angstrom`. Empty for
    // what has no others, and for a residue or atom on a spring.
    std::optional<double> free_s = {};
    double closest = 0;  // the shortest such distance of the whole path
    // RMSD between end and start, as in session/compare_poses.h: of its heavy atoms, of the
    // backbone of the others, and of the side chains of the pocket.
    double last_rmsd = 0, last_backbone = 0, last_pocket = 0;
};

// The path of a molecule that the hand moves in space, or of the residue or atom that its spring
// pulls.
class UnbindingLog {
public:
    explicit UnbindingLog(const World& start, double time_s = 0);

    // Whether the world has the same atoms, and the first hand holds the same ones.
    bool suits(const World& world) const;
    void add(const World& world, double time_s);
    UnbindingPath unbinding() const;

private:
    std::vector<std::size_t> heavy_, other_heavy_;
    PoseComparison comparison_;
    std::vector<Vec3> start_, last_;  // positions of all atoms
    Vec3 start_centre_ = Vec3::Zero();
    bool is_whole_ = true;  // the hand holds a molecule, not a part of one
    UnbindingPath unbinding_;
};

}  // namespace palpa
