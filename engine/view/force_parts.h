// What residues or atoms do to what is in a hand: the force on it in parts.
#pragma once
#include "ecs/world.h"
#include "math/vec.h"
#include "render/frame_scene.h"
#include "scene/choices.h"
#include "view/pocket.h"
#include "view/signs.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace palpa {

// Of every atom of the table the force (kcal/mol/Å) that it exerts on these: non-bonded pairs, of
// atoms within `reach` (Å); none of these themselves, and of those bonded to them over three bonds
// or fewer.
std::vector<Vec3> find_forces_by_atoms(const World& world, std::span<const std::uint32_t> held,
                                       double reach = std::numeric_limits<double>::infinity());

struct ForcePart {
    std::size_t first = 0, end = 0;  // atoms that exert it
    Vec3 force = Vec3::Zero();       // on what is held, kcal/mol/Å
};

// Of residues, or of single atoms, that exert more than the least force that is shown, on what the
// hand holds, as far as the hand may move it, along x or in space; the strongest first, without a
// reach. Of a rigid molecule in hand they sum to the force on the hand's arrow, but for those that
// are weaker. Nothing for ShownForces::Hand. The hand must hold something.
std::vector<ForcePart> find_force_parts(const World& world, Entity hand, ShownForces of,
                                        std::span<const ResidueSpan> residues,
                                        double least_nN = least_shown_nN);

// Where an arrow of a part begins and ends: each place is the mean of its atoms', weighted by the
// force that each has from or on the others.
struct ForceEnds {
    Vec3 from = Vec3::Zero();  // among the atoms that exert it
    Vec3 on = Vec3::Zero();    // among those that are held
};
ForceEnds find_ends(const World& world, Entity hand, const ForcePart& part);

// An arrow on the side of `from`: of an attraction it starts on what is held, of a repulsion it
// ends there. As long as the arrow of such a force on the hand, half as thick. Returns its other
// end.
glm::vec3 add_force_part(const Vec3& force_nN, const ForceEnds& ends, float decade,
                         FrameScene& frame);

// The arrows of the strongest 10 residues or 20 atoms, with their names and forces beside them,
// those of the strongest 6 first to find room.
void add_force_parts(const World& world, Entity hand, ShownForces of,
                     std::span<const ResidueSpan> residues, const HeldMolecule& held,
                     FrameScene& frame, std::vector<ViewLabel>& labels);

}  // namespace palpa
