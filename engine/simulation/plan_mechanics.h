// The torsion model of a world: bodies and bases of mobile molecules, and what hands hold of them.
#pragma once
#include "assembly/bodies.h"
#include "ecs/world.h"
#include "simulation/resources.h"
#include "statics/torsion_model.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// Bodies and bases as molecules may now move.
struct MechanicsPlan {
    ModelAtoms atoms;
    TorsionBodies bodies;
    std::vector<MoleculeBase> bases;
    std::size_t joints = 0, joints_held = 0;
};

// Throws LoadError as find_joints does.
MechanicsPlan plan_mechanics(World& world);

// The hold of a hand: the molecule of the torsion model whose base it moves, or the spring by which
// it pulls.
struct HeldPart {
    std::uint32_t base = 0;
    std::optional<ModelSpring> spring = {};
};

// Lists the holds of hands in their order. Throws LoadError for a molecule in pieces that a hand
// holds as a whole.
std::vector<HeldPart> find_held(const World& world, const MechanicsPlan& plan);

// The model at the present positions, with other freedom of its bases.
TorsionModel build_model(World& world, const MechanicsPlan& plan, std::vector<MoleculeBase> bases);

}  // namespace palpa
