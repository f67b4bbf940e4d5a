// The force on what a hand holds, split by residues or atoms.
#pragma once
#include "ecs/world.h"
#include "math/vec.h"
#include "render/frame_scene.h"
#include "scene/choices.h"
#include "simulation/grip_queries.h"
#include "view/pocket.h"
#include "view/signs.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace palpa {

// Held atoms, gathered once a frame for the functions below.
struct HeldPoints {
    std::vector<std::uint32_t> numbers;  // of the table
    // One per atom of the table: whether it is held, or within three bonds of one that is. Such
    // atoms exert no non-bonded force here.
    std::vector<bool> is_bonded;
    GatheredPoints points;
};
HeldPoints gather_held(const World& world, std::vector<std::uint32_t> numbers);

// Returns one vector per atom of the table: the non-bonded force (kcal/mol/Å) that it exerts on the
// held atoms. It is zero for held atoms, for atoms within three bonds of these, and for atoms
// farther than `reach` (Å) from all of them.
std::vector<Vec3> find_forces_by_atoms(const World& world, const HeldPoints& held,
                                       double reach = std::numeric_limits<double>::infinity());

struct ForcePart {
    std::size_t first = 0, end = 0;  // atoms that exert it
    Vec3 force = Vec3::Zero();       // on the held atoms, kcal/mol/Å
};

// Returns the residues, or single atoms, that exert more than `least_nN` on what the hand holds,
// the strongest first. No distance is too large. Forces are projected on the directions in which
// the hand may move. For a rigid held molecule the parts sum to the force on the hand's arrow, less
// the parts that are too weak. ShownForces::Hand gives no parts. The hand must hold something;
// `held`: its held_atoms.
std::vector<ForcePart> find_force_parts(const World& world, Entity hand, const HeldPoints& held,
                                        ShownForces of, std::span<const ResidueSpan> residues,
                                        double least_nN = least_shown_nN);

// Where an arrow of a part begins and ends. Each place is a mean over atoms, weighted by the size
// of the force that acts on each atom.
struct ForceEnds {
    Vec3 from = Vec3::Zero();  // among the atoms that exert it
    Vec3 on = Vec3::Zero();    // among the held atoms
};
ForceEnds find_ends(const World& world, const HeldPoints& held, const ForcePart& part);

// Draws an arrow on the side of `from`. An attraction starts on the held atoms, a repulsion ends
// there. The arrow is as long as one of the same force on the hand, and half as thick. Returns the
// end that is away from the held atoms.
glm::vec3 add_force_part(const Vec3& force_nN, const ForceEnds& ends, float decade,
                         FrameScene& frame);

// Draws the arrows of the strongest 10 residues or 20 atoms, labelled with name and force. The
// labels of the strongest 6 are always shown, the others where there is room.
void add_force_parts(const World& world, Entity hand, ShownForces of,
                     std::span<const ResidueSpan> residues, const HeldMolecule& held,
                     FrameScene& frame, std::vector<ViewLabel>& labels);

}  // namespace palpa
