// Compares poses of molecules by rms distances.
#pragma once
#include "ecs/world.h"
#include "molecule/symmetry.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// rms distances of heavy atoms, Å; 0 where there are none.
struct PoseDistance {
    double held = 0;      // atoms that the first hand holds
    double backbone = 0;  // N, CA, C and O of all other atoms
    double pocket = 0;    // side chains of residues with a heavy atom within 5 Å of what is held
};

// Poses are superposed on the backbone of the molecule that the hand's place is measured from (its
// heavy atoms where it has no residues of a protein), but not where the hand holds a spring, since
// that is within a molecule whose base does not move. Atoms that only their numbers tell apart
// may change places: all those of what is held together, those of others by residue.
class PoseComparison {
public:
    // Determines pocket and symmetries from the present world.
    explicit PoseComparison(const World& world);

    // Positions of all atoms of the table.
    PoseDistance between(std::span<const Vec3> from, std::span<const Vec3> to) const;
    std::size_t pocket_residues() const noexcept { return pocket_.size(); }

private:
    std::vector<std::uint32_t> frame_, backbone_;
    SymmetricAtoms held_;
    std::vector<SymmetricAtoms> pocket_;
};

}  // namespace palpa
