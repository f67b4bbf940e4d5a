// Every component an entity can have. Plain data; what acts on it are the systems of step.h.
#pragma once
#include "ecs/entity.h"
#include "haptics/exchange.h"
#include "math/vec.h"
#include "molecule/atoms.h"
#include "scene/description.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct Connectivity;

// ---- of a molecule ---------------------------------------------------------------------------

// It owns a range of the atom table.
struct Molecule {
    std::string name;
    AtomRange atoms;
    std::uint32_t reference_atom = 0;  // index into the table; stands for the molecule's place
};

// Where it is. Written by what moves it: the hand, or relaxation.
struct Pose {
    Vec3 place = Vec3::Zero();            // Å, of the reference atom
    Quat orientation = Quat::Identity();  // about that atom, from how it was loaded
};

// Of a molecule that moves as one piece outside of the mechanics: its atoms from the reference atom
// (Å), as they were loaded.
struct RigidShape {
    std::vector<Vec3> atoms;
};

// Its atoms' places (Å) when the scene began, or when it was added.
struct StartPlaces {
    std::shared_ptr<const std::vector<Vec3>> atoms;
};

// Where its atoms and bonds are from. What is bonded is read or generated when something mobile
// asks for it.
struct Source {
    std::shared_ptr<const Structure> structure;
    std::shared_ptr<const Connectivity> connectivity;
    std::string segment;
};

// What it may do by itself or with the hand, and whether its joints may turn.
struct Mobility {
    Motion motion = Motion::Fixed;
    Shape shape = Shape::Rigid;
};

// How it is drawn, where that is not as everything else.
struct Appearance {
    std::optional<Representation> representation;
    std::optional<Colouring> colouring;
    bool visible = true;
};

// ---- of a hand ---------------------------------------------------------------------------------

// What the device said up to the last step. Hands stand in the order of their devices.
struct Hand {
    Vec3 travel_m = Vec3::Zero();  // the handle's
    Quat turn = Quat::Identity();  // and its turn
    bool turns = false;            // rigid molecules as it is turned
};

// What a hand holds, and how it moves it. Places are measured from `anchor`.
struct Grip {
    Entity molecule;
    // Where a spring holds some of its atoms, these, counted from its first, and the spring's k
    // (kcal/mol/Å^2).
    std::vector<std::uint32_t> atoms;
    double k = 0;
    Mobility before;  // of the molecule, which it has again when the hand lets go
    Entity measured_from;
    Vec3 anchor = Vec3::Zero();  // Å, the reference atom of that molecule when the hand took hold

    int freedom = 1;                              // 1: along x, 3: in space, 6: turned as well
    Mat3 projector = Vec3::UnitX().asDiagonal();  // onto where the hand may move it
    // Of the molecule's reference atom, or of the hand's end of the spring.
    MoleculePose pose;
    // The line on which forces are probed: along x through this place, where the distance is 0. On
    // a line that is the anchor; in space the place of rest, or beside it where the hand starts
    // beside it.
    Vec3 line_origin = Vec3::Zero();  // Å

    // How the mechanics have it: which molecule of the torsion model it is, -1 for none, and the
    // spring by which the hand pulls at it, -1 where the hand moves its base.
    std::int32_t base = -1, spring = -1;
    bool is_new = true;  // its pose is not yet known: that of what it holds
};

// Atoms around what is held, by number; rising, but with smooth ends in an order of neighbours.
struct NearAtoms {
    std::vector<std::uint32_t> atoms;  // empty: not chosen yet
    Vec3 place = Vec3::Zero();         // of the molecule when they were chosen
    std::size_t steps = 0;             // since
    std::size_t most = 0;              // that were asked for
};

// The local contact model of what a hand holds, for its servo.
struct Contact {
    LocalContactModel answer;  // the last, to the hand
    NearAtoms near;
};

// ---- of its own ---------------------------------------------------------------------------------

// Some atoms of a molecule, counted from its first.
struct AtomsOf {
    Entity molecule;
    std::vector<std::uint32_t> atoms;
};

// A spring from the centre of mass of some atoms to that of others, or to a place.
struct Restraint {
    std::vector<AtomsOf> ends;  // one or two
    Vec3 place = Vec3::Zero();  // Å, where there is one
    double k = 0;               // kcal/mol/Å^2
    double length = 0;          // Å
};

// A label of one atom; between two a distance, of three an angle, of four a dihedral.
struct Mark {
    std::vector<AtomsOf> atoms;
    double value = 0;  // Å or degrees, after the last step
};

}  // namespace palpa
