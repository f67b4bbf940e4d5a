// A scene's files become a world.
#pragma once
#include "charmm/topology.h"
#include "core/stage.h"
#include "ecs/world.h"
#include "math/vec.h"
#include "molecule/connectivity.h"
#include "scene/description.h"

#include <vector>

namespace palpa {

// Reads everything the scene names, relaxes a grabbed molecule that moves in space as a rigid body,
// until less than 20 pN pull at it, or everything mobile as the scene's [statics] say, and puts the
// grabbed molecule at its start. `on_stage` hears what takes long. Throws LoadError with the place
// of what is wrong.
World load_world(const SceneDescription& scene, const StageFunction& on_stage = {});

// What a scene's molecules are, in the order of the atom table that load_world makes, and where its
// files have them.
struct SceneSystem {
    Connectivity connectivity;
    Topology topology;
    std::vector<Vec3> positions;  // Å
};

// Without anything moved, held or relaxed. Throws LoadError as load_world does.
SceneSystem load_system(const SceneDescription& scene);

}  // namespace palpa
