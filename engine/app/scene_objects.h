// The entities of a scene as tree and inspector show them: plain copies of their components.
#pragma once
#include "ecs/world.h"
#include "scene/description.h"
#include "scene/edits.h"
#include "simulation/components.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpa {

struct SceneMolecule {
    std::string name;
    std::size_t atoms = 0;
    double mass = 0;    // amu
    double charge = 0;  // e
    Mobility mobility;
    Appearance appearance;
};

struct SceneMark {
    PinEdit atoms;
    double value = 0;  // Å for two atoms, degrees for more
};

struct SceneObjects {
    std::vector<SceneMolecule> molecules;
    std::vector<RestraintEdit> restraints;
    std::vector<SceneMark> marks;
    bool can_relax = false;  // something moves by itself
};

SceneObjects list_objects(const World& world);
// Takes over what steps change; molecules, springs and marks are the same.
void update_values(const World& world, SceneObjects& objects);

}  // namespace palpa
