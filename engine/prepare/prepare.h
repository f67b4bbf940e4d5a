// Prepares a downloaded structure: a system with all atoms, typed, patched and relaxed.
#pragma once
#include "charmm/force_field.h"
#include "charmm/topology.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/stage.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"
#include "prepare/approximate_unknown.h"
#include "prepare/report.h"
#include "prepare/residue_names.h"
#include "prepare/settings.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {

struct PreparedSystem {
    Structure
        structure;  // all atoms in the order of the file, built ones at the end of their residue
    Connectivity connectivity;  // of the same atoms in the same order
    Topology topology;          // of the same atoms in the same order
    ForceField parameters;      // parameters that are used
    Report report;
    Solvent solvent = Solvent::None;  // solvent model of the charges and parameters
    std::vector<ApproximatePart> approximate;
    std::size_t reduced_phosphates = 0;                // number of phosphates with a reduced charge
    std::size_t built_hydrogens = 0, built_heavy = 0;  // atoms that the file lacked
};

// The error for residues that the force field lacks, possibly with other problems.
class UnknownResidues : public LoadError {
public:
    // `is_all`: there are no other problems.
    UnknownResidues(const LoadError& error, std::vector<UnknownResidue> residues, bool is_all)
        : LoadError(error),
          is_all_(is_all),
          residues_(std::make_shared<const std::vector<UnknownResidue>>(std::move(residues))) {}

    const std::vector<UnknownResidue>& residues() const noexcept { return *residues_; }
    bool is_all() const noexcept { return is_all_; }

private:
    bool is_all_;
    std::shared_ptr<const std::vector<UnknownResidue>> residues_;  // copies must not throw
};

// The same of a topology that somebody has made already (.psf), with coordinates of all its atoms:
// names, types, charges and bonds are taken as they are, nothing is built or moved, and there is no
// implicit water, which needs other charges. Throws LoadError for atoms without a place (as
// match_positions), parameters that are missing (build_topology), and coordinates that cannot be
// those of the molecules (check_coordinates).
PreparedSystem adopt_system(const ForceField& force_field, Connectivity connectivity,
                            const Structure& coordinates);

// What a topology file of the system says of itself: `title`, and before it the origin of charges
// that are not the force field's own.
std::string topology_title(const PreparedSystem& system, std::string_view title);

// The stages are listed in engine/design.md. Throws LoadError with everything that is missing:
// residues (UnknownResidues), atoms, patches and parameters.
PreparedSystem prepare_system(const ForceField& force_field, const Structure& structure,
                              const PrepareSettings& settings, const StageFunction& progress);

// system.psf, system.pdb, system.crd, system.prm, report.txt, approximate.str where something is,
// and those of `scene`, named without folder: all of them or none. `title`: what the files say of
// themselves; it ends with prepared_mark, by which they are known again. Where they replace those
// of an earlier preparation, the others of prepared_names that it left are removed.
void write_prepared(const PreparedSystem& system, const std::filesystem::path& folder,
                    std::string_view title, std::span<const TextFile> scene,
                    Existing existing = Existing::Refuse);
inline constexpr std::string_view prepared_mark = "by palpa prepare";
inline constexpr std::array prepared_names{"system.psf", "system.pdb",  "system.crd",
                                           "system.prm", "report.txt",  "approximate.str",
                                           "scene.toml", "relaxed.crd", "scene.psf"};

}  // namespace palpa
