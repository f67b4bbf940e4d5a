// From a structure as it was downloaded to a system with every atom, typed, patched and relaxed.
#pragma once
#include "charmm/force_field.h"
#include "charmm/topology.h"
#include "core/files.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"
#include "prepare/report.h"
#include "prepare/settings.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace palpa {

struct PreparedSystem {
    Structure structure;  // every atom, in the order of the file, built ones behind their residue's
    Connectivity connectivity;  // of the same atoms in the same order
    Topology topology;          // likewise
    ForceField parameters;      // what of the force field is used
    Report report;
};

// What is being done, and how far it is, 0 to 1.
using PrepareProgress = std::function<void(std::string_view stage, double share)>;

// The stages are listed in engine/README.md. Throws LoadError with everything that is missing:
// residues, atoms, patches and parameters.
PreparedSystem prepare_system(const ForceField& force_field, const Structure& structure,
                              const PrepareSettings& settings, const PrepareProgress& progress);

// A scene file that gives this segment to the hand, in space, and holds the others: constant gains,
// a period that two cores can keep, the stroke `hold`. Throws LoadError if there is no such segment
// or no other.
std::string format_scene_of(const PreparedSystem& system, const std::string& segment,
                            std::string_view title);

// The segment of the fewest atoms, ions last, or nothing where there is only one: what a hand would
// take.
std::string find_smallest_segment(const PreparedSystem& system);

// system.psf, system.pdb, system.crd, system.prm, report.txt and, unless `scene` is empty,
// scene.toml: all of them or none. `title`: what the files say of themselves; it ends with
// prepared_mark, by which they are known again.
void write_prepared(const PreparedSystem& system, const std::filesystem::path& folder,
                    std::string_view title, std::string_view scene,
                    Existing existing = Existing::Refuse);
inline constexpr std::string_view prepared_mark = "by palpa prepare";

}  // namespace palpa
