#include "prepare/prepare.h"

#include "charmm/build_topology.h"
#include "charmm/complete.h"
#include "charmm/generate.h"
#include "charmm/write_parameters.h"
#include "core/files.h"
#include "core/load_error.h"
#include "formats/crd.h"
#include "formats/pdb.h"
#include "formats/psf.h"
#include "prepare/atom_names.h"
#include "prepare/choose.h"
#include "prepare/residue_names.h"
#include "prepare/segments.h"

#include <fmt/format.h>
#include <array>
#include <string>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

// What of the system follows from names alone.
struct TypedSystem {
    CompletedStructure completed;
    GenerateSettings settings;
    Connectivity connectivity;
    Topology topology;
};

TypedSystem type_system(const ForceField& force_field, const NamedResidues& named,
                        const PrepareSettings& settings, Report& report) {
    TypedSystem system;
    Structure structure = named.structure;
    system.settings = split_segments(force_field, structure, named.patches, settings, report);
    structure = name_atoms(force_field, structure, system.settings, report);
    system.completed = add_missing_atoms(force_field, structure, system.settings);
    system.connectivity =
        build_connectivity(force_field, system.completed.structure, system.settings);
    system.topology = build_topology(system.connectivity, force_field);
    return system;
}

void create_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw LoadError({folder.string()}, fmt::format("no folder: {}", error.message()));
}

}  // namespace

PreparedSystem prepare_system(const ForceField& force_field, const Structure& structure,
                              const PrepareSettings& settings, const PrepareProgress& progress) {
    PreparedSystem result;
    Report& report = result.report;
    progress("choosing and naming atoms", 0);
    const Structure chosen = choose_atoms(structure, settings, report);
    const NamedResidues named = name_residues(force_field, chosen, settings, report);
    TypedSystem system;
    try {
        if (!named.structure.names.empty()) {
            system = type_system(force_field, named, settings, report);
        }
    } catch (const LoadError& error) {
        if (!named.problems) throw;
        throw LoadError({}, fmt::format("{}; {}", named.problems->what(), error.what()));
    }
    if (named.problems) throw LoadError(*named.problems);
    result.structure = std::move(system.completed.structure);
    result.connectivity = std::move(system.connectivity);
    result.topology = std::move(system.topology);
    return result;
}

void write_prepared(const PreparedSystem& system, const std::filesystem::path& folder,
                    std::string_view title) {
    // Everything is made before anything is written.
    const std::array<std::pair<const char*, std::string>, 5> files{
        {{"system.psf", format_psf(system.connectivity, title)},
         {"system.pdb", format_pdb(system.structure, title)},
         {"system.crd", format_crd(system.structure, title)},
         {"system.prm", format_parameters(system.parameters, title)},
         {"report.txt", fmt::format("{}\n\n{}", title, system.report.to_text())}}};
    create_folder(folder);
    for (const auto& [name, text] : files) write_text_file(folder / name, text);
}

}  // namespace palpa
