// A large molecule shown by its backbone, with those residues in full that are near to what is in
// hand.
#pragma once
#include "ecs/world.h"
#include "molecule/atoms.h"
#include "render/frame_scene.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace palpa {

// Atoms from `first` to before `end`.
struct ResidueSpan {
    std::size_t first = 0, end = 0;
    std::size_t alpha = 0;  // its atom CA, or `end` where it has none
};

// Of all but the grabbed molecule, in the order of the table.
std::vector<ResidueSpan> find_residues(const World& world);

// Which atoms of others than the grabbed molecule stand for themselves, an entry for each atom of
// the table: those of residues without an atom CA, and of residues with an atom within 4.5 Å of the
// grabbed molecule.
std::vector<bool> find_pocket(const World& world, std::span<const ResidueSpan> residues);

// A smooth tube along the atoms CA of others than the grabbed molecule, a uniform cubic B-spline,
// picked as the nearest of them. `colours` is one an atom. It is open where residues are missing:
// where two atoms CA are more than 4.5 Å apart.
void add_backbones(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                   std::span<const glm::vec3> colours, FrameScene& frame);

}  // namespace palpa
