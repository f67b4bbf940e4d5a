#include "prepare/prepare.h"

#include "charmm/build_topology.h"
#include "charmm/complete.h"
#include "charmm/generate.h"
#include "charmm/ionic_groups.h"
#include "charmm/missing.h"
#include "charmm/used_parameters.h"
#include "charmm/write_parameters.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "formats/crd.h"
#include "formats/pdb.h"
#include "formats/psf.h"
#include "molecule/alternatives.h"
#include "molecule/match_atoms.h"
#include "molecule/residue_kinds.h"
#include "prepare/align.h"
#include "prepare/atom_names.h"
#include "prepare/build_positions.h"
#include "prepare/check_coordinates.h"
#include "prepare/choose.h"
#include "prepare/orient.h"
#include "prepare/phosphates.h"
#include "prepare/relax.h"
#include "prepare/residue_names.h"
#include "prepare/residues.h"
#include "prepare/segments.h"
#include "prepare/solvent.h"

#include <fmt/format.h>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// What of the system follows from names alone.
struct TypedSystem {
    CompletedStructure completed;
    GenerateSettings settings;
    Connectivity connectivity;
    Topology topology;
    std::optional<SolvatedSystem> solvated;  // the same atoms in implicit water
};

TypedSystem type_system(const ForceField& force_field, const NamedResidues& named,
                        const PrepareSettings& settings, Report& report) {
    TypedSystem system;
    Structure structure = named.structure;
    system.settings =
        split_segments(force_field, structure, named.patches, settings, report, named.links);
    structure = name_atoms(force_field, structure, system.settings, report);
    system.completed = add_missing_atoms(force_field, structure, system.settings);
    system.connectivity =
        build_connectivity(force_field, system.completed.structure, system.settings);
    system.topology = build_topology(system.connectivity, force_field);
    system.solvated =
        solvate(force_field, system.completed.structure, system.settings, settings, report);
    return system;
}

// Protein files name no elements with their types; whoever draws the system needs them.
void name_elements(PreparedSystem& system) {
    for (std::size_t i = 0; i < system.structure.names.size(); ++i) {
        const auto type = system.parameters.types.find(system.connectivity.type[i]);
        if (type == system.parameters.types.end() || !type->second.element.empty()) continue;
        type->second.element = element_of(system.structure, i);
    }
}

void check_size(const Structure& structure) {
    constexpr std::size_t most_atoms = 200'000;
    const std::size_t atoms = structure.names.size();
    if (atoms <= most_atoms) return;
    throw LoadError({structure.file},
                    fmt::format("{} atoms; expected at most {}: leave out chains that are not "
                                "needed (--without chain:B), waters first, or build no assembly",
                                atoms, most_atoms));
}

// As CHARMM writes PDB files: four letters of a residue's name, of which sugars have six.
Structure with_short_names(Structure structure) {
    constexpr std::size_t most = 4;
    for (AtomName& name : structure.names) {
        if (name.residue.size() > most) name.residue.resize(most);
    }
    return with_short_chains(std::move(structure));
}

// Names and numbers must fit the columns of the files that will be written, which is known before
// the long work.
void check_formats(Structure structure) {
    structure.positions.assign(structure.names.size(), Vec3::Zero());
    (void)format_pdb(with_short_names(std::move(structure)), {});
}

void report_charge(PreparedSystem& system) {
    double charge = 0;
    for (const double q : system.topology.charge) charge += q;
    system.report.add(
        "System",
        fmt::format("{} atoms, charge {:+.2f} e, {} bonds, {} angles, "
                    "{} dihedrals, {} impropers, {} CMAP terms",
                    system.structure.names.size(), charge, system.connectivity.bonds.size(),
                    system.connectivity.angles.size(), system.connectivity.dihedrals.size(),
                    system.connectivity.impropers.size(), system.connectivity.cmaps.size()));
}

std::string atom_label(const PreparedSystem& system, std::uint32_t atom) {
    return to_string(system.structure.names[atom]);
}

void build_missing(PreparedSystem& system, const std::vector<AtomCoordinate>& coordinates) {
    const BuiltPositions built = build_positions(system.connectivity, system.topology, coordinates,
                                                 system.structure.positions);
    std::size_t guesses = 0, hydrogens = 0;
    std::string guessed;
    for (const PlacedAtom& placed : built.placed) {
        const bool is_hydrogen = element_of(system.structure, placed.atom) == "H";
        if (is_hydrogen) ++hydrogens;
        if (is_hydrogen || placed.by != PlacedBy::Guess) continue;
        if (++guesses <= 5) guessed += fmt::format(" {},", atom_label(system, placed.atom));
    }
    system.built_hydrogens = hydrogens;
    system.built_heavy = built.placed.size() - hydrogens;
    system.report.add("Atoms built", fmt::format("{} hydrogens, {} heavy atoms",
                                                 system.built_hydrogens, system.built_heavy));
    if (guesses > 0) {
        guessed.pop_back();
        system.report.warn(
            fmt::format("{} heavy atoms were built without a dihedral from an IC "
                        "table:{}",
                        guesses, guessed));
    }
    if (built.unplaced.empty()) return;
    Missing missing;
    for (const std::uint32_t atom : built.unplaced) {
        missing.add({system.structure.file, system.structure.lines[atom], 0},
                    fmt::format("{} cannot be built: no atom bonded to it has coordinates; leave "
                                "its residue out with --without",
                                atom_label(system, atom)));
    }
    missing.throw_if_any();
}

void orient(PreparedSystem& system, std::span<const std::uint32_t> added,
            const PrepareSettings& settings) {
    OrientSettings orient_settings;
    // Thousands of waters settle slowly, and need not: each has been turned twice.
    constexpr std::size_t many = 3000;
    if (settings.keeps_waters && added.size() > many) orient_settings.sweep_limit = 2;
    const OrientReport oriented = orient_groups(system.connectivity, system.topology, added,
                                                orient_settings, system.structure.positions);
    constexpr std::string_view heading = "Hydrogen bonds";
    system.report.add(heading, fmt::format("{} groups turned to their lowest energy, {:.1f} "
                                           "kcal/mol gained in {} sweeps",
                                           oriented.groups.size(), std::abs(oriented.energy_change),
                                           oriented.sweeps));
    if (!oriented.is_settled) {
        system.report.warn("the search for hydrogen bonds stopped before it converged");
    }
}

std::string contact_label(const PreparedSystem& system, const std::optional<AtomContact>& contact) {
    if (!contact) return "none within 4 Å";
    return fmt::format("{:.2f} Å, {} and {}", contact->distance, atom_label(system, contact->a),
                       atom_label(system, contact->b));
}

void warn_of_clash(PreparedSystem& system, const std::optional<AtomContact>& closest) {
    constexpr double clash = 1.5;  // Å
    if (!closest || closest->distance > clash) return;
    system.report.warn(fmt::format("a clash remains: {}", contact_label(system, closest)));
}

void relax_system(PreparedSystem& system, std::span<const std::uint8_t> is_built,
                  const StageFunction& progress) {
    const std::size_t count = system.structure.names.size();
    std::vector<std::uint8_t> is_hydrogen(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        is_hydrogen[i] = element_of(system.structure, i) == "H" ? 1 : 0;
    }
    const ClashReport relaxed =
        relax(system.topology, is_built, is_hydrogen, system.structure.positions,
              [&](double share) { tell(progress, for_translation("relaxing clashes"), share); });
    constexpr std::string_view heading = "Relaxation";
    system.report.add(
        heading,
        fmt::format(
            "{:.2f} to {:.2f} kcal/mol in {} steps (dielectric 4 r, cutoff 9 Å, heavy atoms of the "
            "file restrained by 5 kcal/mol/Å^2); remaining rms force {:.2f} kcal/mol/Å",
            relaxed.before.total(), relaxed.after.total(), relaxed.steps, relaxed.rms_force));
    system.report.add(heading, fmt::format("closest contact before: {}",
                                           contact_label(system, relaxed.closest_before)));
    system.report.add(heading, fmt::format("closest contact after: {}",
                                           contact_label(system, relaxed.closest_after)));
    system.report.add(heading, fmt::format("largest move of an atom of the file: {:.2f} Å, {}",
                                           relaxed.largest_move.distance,
                                           atom_label(system, relaxed.largest_move.a)));
    warn_of_clash(system, relaxed.closest_after);
    constexpr double large_force = 1;  // kcal/mol/Å
    if (relaxed.rms_force > large_force) {
        system.report.warn(
            fmt::format("the relaxation stopped early: an rms force of {:.1f} kcal/mol/Å remains",
                        relaxed.rms_force));
    }
}

// Hydrogens were turned and clashes relaxed with full charges, so that coordinates are the same
// with and without a solvent.
void take_solvated(SolvatedSystem solvated, PreparedSystem& system) {
    system.solvent = Solvent::Eef1Sb;
    system.connectivity = std::move(solvated.connectivity);
    system.topology = std::move(solvated.topology);
    system.parameters = keep_used_parameters(solvated.force_field, system.connectivity);
    name_elements(system);
    report_charge(system);
}

// Likewise after everything has been placed with full charges.
void take_reduced_phosphates(PreparedSystem& system) {
    system.reduced_phosphates = reduce_phosphates(system.connectivity, system.connectivity.charge);
    if (system.reduced_phosphates == 0) return;
    reduce_phosphates(system.connectivity, system.topology.charge);
    const double charge =
        std::accumulate(system.topology.charge.begin(), system.topology.charge.end(), 0.0);
    system.report.add(
        "Solvent",
        fmt::format(
            "in vacuum {} phosphates of nucleic acids have {} e instead of -1 e, and the scene has "
            "a dielectric of {}, to replace missing counterions and water (--full-phosphates keeps "
            "-1 e and a dielectric of 1); charge of the system {:+.2f} e",
            system.reduced_phosphates, reduced_phosphate_charge, nucleic_dielectric, charge));
}

// The oxygens of waters of the file that are no part of the system.
std::vector<Vec3> find_left_out_waters(const Structure& structure, const Structure& chosen,
                                       PrepareSettings settings) {
    settings.keeps_waters = true;
    Report unused;
    const Structure all = choose_atoms(structure, settings, unused);
    std::set<std::size_t> lines(chosen.lines.begin(), chosen.lines.end());
    std::vector<Vec3> waters;
    for (std::size_t i = 0; i < all.names.size(); ++i) {
        const bool is_oxygen = is_water(all.names[i].residue) && element_of(all, i) == "O";
        if (is_oxygen && !lines.contains(all.lines[i])) waters.push_back(all.positions[i]);
    }
    return waters;
}

std::string format_approximate(const PreparedSystem& system, std::string_view title) {
    std::string text;
    for (const std::string_view line : split_lines(title)) text += fmt::format("* {}\n", line);
    for (const ApproximatePart& part : system.approximate) text += part.stream;
    return text;
}

}  // namespace

PreparedSystem prepare_system(const ForceField& given_force_field, const Structure& structure,
                              const PrepareSettings& settings, const StageFunction& progress) {
    PreparedSystem result;
    Report& report = result.report;
    tell(progress, for_translation("choosing and naming atoms"));
    for (const std::string& doubt : structure.doubts) report.warn(doubt);
    Structure chosen = choose_atoms(structure, settings, report);
    check_size(chosen);
    ApproximatedUnknown approximated;
    if (settings.approximates_ligands) {
        tell(progress, for_translation("approximating ligands"));
        approximated = approximate_unknown(given_force_field, chosen, settings, report);
        chosen = std::move(approximated.structure);
        result.approximate = std::move(approximated.parts);
    }
    const ForceField& force_field =
        settings.approximates_ligands ? approximated.force_field : given_force_field;
    const NamedResidues named = name_residues(force_field, chosen, settings, report,
                                              find_left_out_waters(structure, chosen, settings));
    Missing problems = named.problems;
    for (const LoadError& error : approximated.refused) problems.add(error);
    TypedSystem system;
    try {
        if (!named.structure.names.empty()) {
            system = type_system(force_field, named, settings, report);
        }
    } catch (const LoadError& error) {
        if (problems.empty()) throw;
        problems.add(error);
    }
    try {
        problems.throw_if_any();
    } catch (const LoadError& error) {
        if (named.unknown.empty()) throw;
        throw UnknownResidues(error, named.unknown, problems.size() == named.unknown.size());
    }
    result.structure = std::move(system.completed.structure);
    result.connectivity = std::move(system.connectivity);
    result.topology = std::move(system.topology);
    result.parameters = keep_used_parameters(force_field, result.connectivity);
    name_elements(result);
    check_size(result.structure);
    std::vector<std::uint8_t> is_added(result.structure.names.size(), 0);
    for (const std::uint32_t atom : system.completed.added) is_added[atom] = 1;
    check_formats(result.structure);
    check_coordinates(result.structure, result.topology, is_added, report);
    if (!system.solvated) report_charge(result);

    tell(progress, for_translation("building missing atoms"));
    const std::vector<AtomCoordinate> coordinates =
        find_internal_coordinates(force_field, result.structure, system.settings);
    build_missing(result, coordinates);
    tell(progress, for_translation("orienting hydrogens"));
    orient(result, system.completed.added, settings);
    if (settings.relaxes) {
        relax_system(result, is_added, progress);
    } else {
        warn_of_clash(result, find_closest_contact(result.topology, result.structure.positions));
    }
    if (system.solvated) {
        take_solvated(std::move(*system.solvated), result);
    } else if (!settings.keeps_phosphate_charges && !settings.keeps_waters) {
        take_reduced_phosphates(result);
    }
    if (settings.align) align(result.structure, *settings.align, result.structure.positions);
    return result;
}

PreparedSystem adopt_system(const ForceField& force_field, Connectivity connectivity,
                            const Structure& coordinates) {
    PreparedSystem result;
    refuse_alternatives(coordinates);
    result.structure.file = coordinates.file;
    result.structure.names = connectivity.names;
    result.structure.lines = connectivity.lines;
    result.structure.positions = match_positions(connectivity, coordinates);
    check_size(result.structure);
    check_formats(result.structure);
    result.topology = build_topology(connectivity, force_field);
    result.connectivity = std::move(connectivity);
    result.parameters = keep_used_parameters(force_field, result.connectivity);
    name_elements(result);
    const std::vector<std::uint8_t> none_added(result.structure.names.size(), 0);
    check_coordinates(result.structure, result.topology, none_added, result.report);
    report_charge(result);
    result.report.add("System",
                      fmt::format("atoms, types, charges and bonds are those of {}; nothing was "
                                  "built, and it stands in vacuum",
                                  result.connectivity.file));
    warn_of_clash(result, find_closest_contact(result.topology, result.structure.positions));
    return result;
}

std::string topology_title(const PreparedSystem& system, std::string_view title) {
    if (system.solvent == Solvent::Eef1Sb)
        return fmt::format("{}\n{}", neutral_charges_origin, title);
    if (system.reduced_phosphates > 0)
        return fmt::format(
            "Phosphates of {} e: B. Tidor et al., J. Biomol. Struct. Dyn. 1, 231 "
            "(1983).\n{}",
            reduced_phosphate_charge, title);
    return std::string(title);
}

void write_prepared(const PreparedSystem& system, const std::filesystem::path& folder,
                    std::string_view title, std::span<const TextFile> scene, Existing existing) {
    std::vector<TextFile> files{
        {folder / "system.psf", format_psf(system.connectivity, topology_title(system, title))},
        {folder / "system.pdb", format_pdb(with_short_names(system.structure), title)},
        {folder / "system.crd", format_crd(system.structure, title)},
        {folder / "system.prm", format_parameters(system.parameters, title)},
        {folder / "report.txt", fmt::format("{}\n\n{}", title, system.report.to_text())}};
    if (!system.approximate.empty()) {
        files.push_back({folder / "approximate.str", format_approximate(system, title)});
    }
    for (const TextFile& file : scene) files.push_back({folder / file.path, file.text});
    for (TextFile& file : files) file.existing = existing;
    make_folder(folder);
    write_text_files(files);
    if (existing == Existing::Refuse) return;
    for (const char* const name : prepared_names) {
        const std::filesystem::path path = folder / name;
        const bool is_new =
            std::ranges::any_of(files, [&](const TextFile& file) { return file.path == path; });
        std::error_code error;
        if (!is_new && has_mark(path, prepared_mark)) std::filesystem::remove(path, error);
        if (error) throw LoadError({path.string()}, "cannot be removed: " + error.message());
    }
}

}  // namespace palpa
