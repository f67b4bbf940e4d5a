// Every component an entity can have. Plain data; systems are the functions of step.cpp.
#pragma once
#include "ecs/entity.h"
#include "math/vec.h"
#include "molecule/atoms.h"

#include <cstdint>
#include <string>

namespace palpa {

// A molecule owns a range of the atom table.
struct Molecule {
    std::string name;
    AtomRange atoms;
    std::uint32_t reference_atom = 0;  // index into the table; stands for the molecule's place
};

// A rigid molecule that may be moved along one line, and does not turn: one degree of freedom.
struct LineGuide {
    Vec3 axis = Vec3::UnitX();  // unit vector
    double distance = 0;        // Å, of its reference atom from the grab's origin, along the axis
};

// A hand: which molecule it holds, where its distance is measured from, and what it did so far.
struct Grab {
    Entity molecule;
    Entity measured_from;
    Vec3 travel_m = Vec3::Zero();  // the handle's, up to the last step
};

}  // namespace palpa
