// The joints that may turn, by the rules of the scene ([joints]) and the mobility of molecules.
#pragma once
#include "assembly/joints.h"
#include "ecs/world.h"
#include "molecule/connectivity.h"
#include "simulation/components.h"
#include "simulation/region.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

// A molecule in the atom table.
struct ScenePart {
    std::string_view name;
    Mobility mobility;
    AtomRange atoms;
    std::uint32_t reference_atom;
};

// Valid until molecules are added, removed or renamed.
std::vector<ScenePart> list_parts(const World& world);

struct SceneJoints {
    Joints joints;
    std::size_t held = 0;  // joints that only the region, or the distance from a molecule, holds
};

// Throws LoadError for bonds of the scene that do not exist or belong to rigid molecules.
SceneJoints find_joints(const World& world, const Connectivity& connectivity,
                        std::span<const Vec3> positions, std::span<const ScenePart> parts,
                        const std::optional<Region>& region);

}  // namespace palpa
