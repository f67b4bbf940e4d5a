// Writes the scene file of a prepared system.
#pragma once
#include "math/vec.h"
#include "molecule/atoms.h"
#include "prepare/hand_choice.h"
#include "prepare/system_segments.h"
#include "scene/choices.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Settings of a scene found by playing it.
struct SceneTuning {
    // The range of forces on the molecule that is felt, pN; unset: constant gains, for a first try.
    std::optional<std::array<double, 2>> feel_pN = {};
    double period_ms = 10;
    std::optional<std::int64_t> relax_steps = {};  // steps of the relaxation on loading
    std::optional<double> region_angstrom =
        {};  // region around what is held; unset: everything moves
    std::string coupling_note, period_note, region_note;  // comments, one line each
    std::string measured_on;                              // as in scene files
};

struct SceneText {
    std::string title, about, made_by;
    std::string structure = "relaxed.crd", topology = "system.psf";  // file names
    Solvent solvent = Solvent::None;
    double dielectric = 1;  // dielectric in vacuum, by which energies are divided
    std::vector<std::string> approximate = {};  // residues with approximate parameters
    std::vector<std::string> rigid = {};        // bonds that do not turn, as in [joints]
};

// Number of atoms above which the scene gets a cutoff of 12 Å.
inline constexpr std::size_t most_atoms_all_pairs = 4'000;

// Guarded coupling, every molecule flexible, ions and waters fixed; the hand leads what it holds by
// 4 Å along `way`, and back. On a spring the molecule's base is away from what is held. A small
// molecule in a large one is shown with its pocket, and otherwise what is in the hand among sticks.
std::string format_scene(const Structure& structure, std::span<const SystemSegment> segments,
                         const HandChoice& hand, const Vec3& way, const SceneText& text,
                         const SceneTuning& tuning);

}  // namespace palpa
