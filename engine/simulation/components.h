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

// A molecule that the handle moves, along x or in space, and may turn. Places are its reference
// atom's, from that of the molecule which the hand measures from.
struct Guide {
    int freedom = 1;                              // 1: along x, 3: in space, 6: turned as well
    Mat3 projector = Vec3::UnitX().asDiagonal();  // onto where it may go
    Vec3 place = Vec3::Zero();                    // Å
    Quat orientation = Quat::Identity();          // about its reference atom, from the start's

    // The line on which the molecule is probed: along x through this place, where the distance is
    // 0. For a molecule on a line that is its counterpart, for one in space its place of rest, or
    // beside it where it starts beside it.
    Vec3 line_origin = Vec3::Zero();  // Å
};

// A hand: which molecule it holds, where its distance is measured from, and what it did so far.
struct Grab {
    Entity molecule;
    Entity measured_from;
    Vec3 travel_m = Vec3::Zero();  // the handle's, up to the last step
    Quat turn = Quat::Identity();  // and its turn
};

}  // namespace palpa
