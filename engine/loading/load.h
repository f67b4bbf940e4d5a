// Loads a scene's files into a world.
#pragma once
#include "charmm/topology.h"
#include "core/stage.h"
#include "ecs/world.h"
#include "math/vec.h"
#include "molecule/connectivity.h"
#include "scene/description.h"

#include <vector>

namespace palpa {

// Reads all files of the scene. Relaxes a rigid held molecule that moves in space until the force
// on it is below 20 pN, or everything mobile as the scene's [statics] say. Moves the held molecule
// to its start. `on_stage` hears of long stages. Throws LoadError with the place of the problem.
World load_world(const SceneDescription& scene, const StageFunction& on_stage = {});

// Loads the scene of a world again, without its edits. Throws LoadError as load_world does.
World load_again(const World& world);

// The molecules of a scene in the order of the atom table of load_world, with positions from the
// files.
struct SceneSystem {
    Connectivity connectivity;
    Topology topology;
    std::vector<Vec3> positions;  // Å
};

// Does not move, hold or relax anything. Throws LoadError as load_world does.
SceneSystem load_system(const SceneDescription& scene);

}  // namespace palpa
