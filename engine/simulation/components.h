// All components of entities. Plain data; the systems of step.h act on them.
#pragma once
#include "ecs/entity.h"
#include "haptics/exchange.h"
#include "haptics/gains.h"
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

// A molecule owns a range of the atom table.
struct Molecule {
    std::string name;
    AtomRange atoms;
    std::uint32_t reference_atom =
        0;  // index into the table; its position is the molecule's position
};

// For a rigid molecule outside of the mechanics that hands move: its atoms relative to the
// reference atom (Å), as loaded, and its rotation about that atom since then until the mechanics
// were built. The pose of a hand that holds it outside of them has the present rotation.
struct RigidShape {
    std::vector<Vec3> atoms;
    Quat orientation = Quat::Identity();
};

// Its atoms' places (Å) when the scene began, or when it was added.
struct StartPlaces {
    std::shared_ptr<const std::vector<Vec3>> atoms;
};

// The origin of its atoms and bonds. The bonds are read or generated when something mobile
// asks for it.
struct Source {
    std::shared_ptr<const Structure> structure;
    std::shared_ptr<const Connectivity> connectivity;
    std::string segment;
    std::string loaded_as{};  // the name in the scene file; empty: an edit added the molecule
};

// How the molecule may move, by itself or with the hand, and whether its joints may turn.
struct Mobility {
    Motion motion = Motion::Fixed;
    Shape shape = Shape::Rigid;
};

// How it is drawn: the Appearance of scene/description.h.

// ---- of a hand ---------------------------------------------------------------------------------

// State of the device at the last step. Hands are in the order of their devices.
struct Hand {
    Vec3 travel_m = Vec3::Zero();  // travel of the handle
    Quat turn = Quat::Identity();  // rotation of the handle
    bool turns = false;            // the rotation of the handle turns rigid molecules
};

// The scene's settings for what the hand takes, and where it began.
struct GripSettings {
    std::string measured_from;                 // name of a molecule, see GrabDescription
    double spring_kcal_per_mol_angstrom2 = 0;  // stiffness of its spring
    Vec3 start_offset = Vec3::Zero();          // Å, start of the hand from its place at rest
};

// The hold of a hand on a molecule: as a whole, or on some of its atoms by the Spring of the hand's
// entity. Positions are relative to `anchor`.
struct Grip {
    Entity molecule;
    Mobility before;  // mobility of the molecule before, restored when the hand releases it
    Entity measured_from;
    Vec3 anchor =
        Vec3::Zero();  // Å, position of the molecule's reference atom when the hand took it

    int freedom = 1;  // 1: along x, 3: in space, 6: in space with rotation
    Mat3 projector = Vec3::UnitX().asDiagonal();  // onto the directions of possible motion
    // Pose of the molecule's reference atom, or of the hand's end of the spring.
    MoleculePose pose;
    // The line on which forces are probed: parallel to x through this point, which has distance 0.
    // In one dimension the point is the anchor; in space it is the pose at rest, or the start of
    // the hand beside it.
    Vec3 line_origin = Vec3::Zero();  // Å

    std::int32_t base = -1;  // index of the molecule in the torsion model; -1: none
    bool is_new = true;      // its pose is not set yet; it will be that of the held molecule
};

// The coupling between the hand and what it holds.
struct Coupling {
    CouplingLaws laws;
    bool is_guarded = false;               // the servo moves the molecule
    std::size_t pairs_per_tick = 130'000;  // pairs that a servo tick has time for
    CouplingDescription description;       // the scene's, as edits have changed it
    bool is_own = false;                   // the scene gives this hand a coupling of its own
};

// Indices of atoms around the held molecule; ascending, but with smooth ends in the order of the
// neighbour list.
struct NearAtoms {
    std::vector<std::uint32_t> atoms;  // empty: not selected yet
    Vec3 place = Vec3::Zero();         // position of the molecule at the selection
    std::size_t steps = 0;             // steps since the selection
    std::size_t most = 0;              // requested number
};

// The local contact model for the servo of a hand.
struct Contact {
    LocalContactModel sent;  // the last one sent to the servo
    NearAtoms near;

    std::size_t count_bytes() const noexcept { return 100 * near.atoms.size(); }  // about
};

// ---- of its own ---------------------------------------------------------------------------------

// Some atoms of a molecule, counted from its first.
struct AtomsOf {
    Entity molecule;
    std::vector<std::uint32_t> atoms;

    friend bool operator==(const AtomsOf&, const AtomsOf&) = default;
};

// A spring between the centres of mass of two groups of atoms, or from one to a point:
// E = k (distance - length)^2/2. It pulls at what is mobile; any number may pull at an atom.
struct Spring {
    std::vector<AtomsOf> ends;  // one or two groups
    Vec3 place = Vec3::Zero();  // Å, the point with one group
    double k = 0;               // kcal/mol/Å^2
    double length = 0;          // Å, at rest
    Entity owner = {};  // a hand, the Clients, an entity of a user's system; none: a restraint
};

// A measurement: a label for one atom, a distance for two, an angle for three, a dihedral for four.
struct Mark {
    std::vector<AtomsOf> atoms;
    double value = 0;  // Å or degrees, after the last step
};

}  // namespace palpa
