// From a structure as it was downloaded to a system with every atom, typed, patched and relaxed.
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
    Structure structure;  // every atom, in the order of the file, built ones behind their residue's
    Connectivity connectivity;  // of the same atoms in the same order
    Topology topology;          // likewise
    ForceField parameters;      // what of the force field is used
    Report report;
    Solvent solvent = Solvent::None;  // that charges and parameters are for
    std::vector<ApproximatePart> approximate;
    std::size_t reduced_phosphates = 0;  // how many have less than their whole charge
};

// What the force field lacks, beside whatever else is wrong.
class UnknownResidues : public LoadError {
public:
    // `is_all`: nothing else is wrong.
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
// themselves; it ends with prepared_mark, by which they are known again.
void write_prepared(const PreparedSystem& system, const std::filesystem::path& folder,
                    std::string_view title, std::span<const TextFile> scene,
                    Existing existing = Existing::Refuse);
inline constexpr std::string_view prepared_mark = "by palpa prepare";

}  // namespace palpa
