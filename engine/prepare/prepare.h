// From a structure as it was downloaded to a system with every atom, typed, patched and relaxed.
#pragma once
#include "charmm/force_field.h"
#include "charmm/topology.h"
#include "core/files.h"
#include "core/stage.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"
#include "prepare/approximate_unknown.h"
#include "prepare/report.h"
#include "prepare/settings.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
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
};

// What a topology file of the system says of itself: `title`, and before it the origin of charges
// that are not the force field's own.
std::string topology_title(const PreparedSystem& system, std::string_view title);

// The stages are listed in engine/design.md. Throws LoadError with everything that is missing:
// residues, atoms, patches and parameters.
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
