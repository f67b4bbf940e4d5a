// Poses of a scene at complete rest, and by how much small moves of the hand change the force on it
// there: a text file, since finding them takes minutes. Lines of words between blanks:
//
//   # Palpa poses 1
//   scene ATOMS BODIES MOLECULES SPRINGS CUTOFF   of its torsion model; Å
//   pose                            each; then, with PAIRS all and with PAIRS cutoff:
//   rest PAIRS ENERGY FX FY FZ      kcal/mol; pN, on the hand
//   angles A ...                    of each body's joint, rad
//   base QW QX QY QZ X Y Z          of each molecule: turn; shift, Å
//   spring X Y Z                    of each: where it is fixed, Å
//   move X Y Z FX FY FZ SNAP        one or more: of the hand, Å; change of the force, pN; 1 where
//                                   shorter strides end elsewhere, else 0
//
// `cutoff` is complete relaxation with forces that end at CUTOFF, `all` with all pairs. Angles are
// written to 1e-10 rad, energies and forces to 1e-6.
#pragma once
#include "math/rigid_motion.h"
#include "math/vec.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

inline constexpr std::string_view rest_poses_mark = "# Palpa poses 1";

struct RestMove {
    Vec3 by;         // move of the hand, Å
    Vec3 change_pN;  // change of the force on it, completely relaxed at both ends
    bool is_snap = false;
};

// Coordinates as in TorsionState.
struct RestPose {
    double energy = 0;             // kcal/mol
    Vec3 force_pN = Vec3::Zero();  // force on the hand
    std::vector<double> angles;    // angle of each body's joint, rad
    std::vector<Quat> turns;       // turn of each molecule; as read, of length 1 within 1e-6
    std::vector<Vec3> shifts;      // shift of each molecule, Å
    std::vector<Vec3> springs;     // place of each spring, Å
    std::vector<RestMove> moves;
    std::size_t line = 0;  // line in the file
};

// The same pose relaxed with all pairs and with a cutoff.
struct RestPosePair {
    RestPose all_pairs, with_cutoff;
};

// The model of the poses.
struct PosedModel {
    std::size_t atoms = 0, bodies = 0, molecules = 0, springs = 0;
    double cutoff = 0;  // Å

    friend bool operator==(const PosedModel&, const PosedModel&) = default;
};

struct RestPoses {
    PosedModel of;
    std::vector<RestPosePair> poses;  // one or more
};

// Throws LoadError with the line for any deviation from this format.
RestPoses parse_rest_poses(std::string_view text, const std::string& file);

// The same for a file, which must contain poses of this model.
RestPoses read_rest_poses(const std::filesystem::path& path, const PosedModel& of);

std::string format_rest_poses(const RestPoses& poses);

}  // namespace palpa
