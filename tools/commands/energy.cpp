#include "tools/commands/energy.h"

#include "charmm/assign_solvation.h"
#include "charmm/build_topology.h"
#include "charmm/force_field.h"
#include "charmm/ionic_groups.h"
#include "charmm/solvation_reader.h"
#include "charmm/type_structure.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "forces/force_field.h"
#include "forces/solvation.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "molecule/coincident_atoms.h"
#include "molecule/match_atoms.h"
#include "scene/choices.h"
#include "tools/commands/choice.h"
#include "tools/commands/command.h"
#include "tools/commands/force_field.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

// In the order of the enumerators after None.
constexpr std::array<std::string_view, 4> electrostatic_names{"switch", "shift", "fshift",
                                                              "fswitch"};
constexpr std::array<std::string_view, 2> van_der_waals_names{"switch", "fswitch"};
constexpr std::array<std::string_view, 2> method_names{"all-pairs", "cutoff"};
constexpr std::array<std::string_view, 2> solvent_end_names{"smooth", "sharp"};
constexpr std::array<std::string_view, 2> exponential_names{"exact", "table"};

// Å. No two nuclei are that close; the shortest bonds, to hydrogen, are ten times as long.
constexpr double coincident_distance = 0.1;
constexpr std::size_t most_warnings = 8;

// With --solvent, how it ends: all as scenes have it, or solvation alone as EEF1 is published.
SolvationEnd find_end(const EnergyOptions& options) {
    if (choice_called("--solvent", options.solvent, solvent_names) == 1) {
        const std::size_t end = choice_called(
            "--solvent-end", options.solvent_end.value_or("smooth"), solvent_end_names);
        return end == 0 ? SolvationEnd::Smooth : SolvationEnd::Sharp;
    }
    if (options.solvent_end || options.solvent_exp || options.solvent_table || options.per_atom ||
        options.structural_water) {
        throw LoadError({"--solvent " + options.solvent},
                        "--solvent-end, --solvent-exp, --solvent-table, --per-atom and "
                        "--structural-water need a solvent; expected --solvent eef1-sb with them");
    }
    return SolvationEnd::None;
}

void choose_cutoff(const EnergyOptions& options, NonbondedSettings& settings) {
    const bool is_chosen =
        options.cutoff || options.switch_from || options.electrostatics || options.van_der_waals;
    if (choice_called("--method", options.method, method_names) == 1) {
        if (settings.solvation == SolvationEnd::Smooth) {
            throw LoadError({"--method " + options.method},
                            "--solvent-end smooth has its own cutoff at 9 Å; expected "
                            "--solvent-end sharp with a cutoff");
        }
        settings.cutoff = options.cutoff.value_or(settings.cutoff);
        settings.switch_from = options.switch_from.value_or(settings.switch_from);
        settings.electrostatics = static_cast<ElectrostaticCutoff>(
            1 + choice_called("--electrostatics", options.electrostatics.value_or("fshift"),
                              electrostatic_names));
        settings.van_der_waals = static_cast<VanDerWaalsCutoff>(
            1 + choice_called("--van-der-waals", options.van_der_waals.value_or("switch"),
                              van_der_waals_names));
    } else if (is_chosen) {
        throw LoadError({"--method " + options.method},
                        "--cutoff, --switch-from, --electrostatics and --van-der-waals need a "
                        "cutoff; expected --method cutoff with them");
    }
}

NonbondedSettings build_settings(const EnergyOptions& options) {
    const SolvationEnd end = find_end(options);
    NonbondedSettings settings;
    if (end == SolvationEnd::Smooth) settings = eef1_settings(end);
    settings.solvation = end;
    const bool is_solvated = end != SolvationEnd::None;
    settings.coulomb_constant = options.coulomb_constant;
    settings.dielectric =
        options.dielectric.value_or(is_solvated ? eef1_settings().dielectric : 1.0);
    settings.distance_dielectric = options.distance_dielectric || is_solvated;
    choose_cutoff(options, settings);
    if (const auto problem = find_problem(settings)) {
        throw LoadError({"--method " + options.method}, std::string(*problem));
    }
    return settings;
}

void warn_of_coincident_atoms(const Connectivity& connectivity, std::span<const Vec3> positions) {
    const auto describe = [&](std::size_t atom) {
        return fmt::format("{} ({})", printable(to_string(connectivity.names[atom])),
                           to_string(TextPlace{connectivity.file, connectivity.lines[atom], 0}));
    };
    const auto pairs = find_coincident_atoms(positions, coincident_distance);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (i == most_warnings) {
            fmt::print(stderr, "warning: and {} more\n", pairs.size() - i);
            break;
        }
        const auto [a, b] = pairs[i];
        fmt::print(stderr, "warning: atoms {} and {} are {:.3f} Å apart\n", describe(a),
                   describe(b), (positions[a] - positions[b]).norm());
    }
}

// Six decimals, as CHARMM compares; of a number that has no room for them, six digits.
std::string format_energy(double value) {
    return std::abs(value) < 1e10 ? fmt::format("{:18.6f}", value) : fmt::format("{:18.6e}", value);
}

using NamedTerm = std::pair<const char*, double>;

std::array<NamedTerm, 12> list_terms(const EnergyTerms& e) {
    return {NamedTerm{"bond", e.bond},
            {"angle", e.angle},
            {"urey_bradley", e.urey_bradley},
            {"dihedral", e.dihedral},
            {"improper", e.improper},
            {"cmap", e.cmap},
            {"lj", e.lj},
            {"lj14", e.lj14},
            {"coulomb", e.coulomb},
            {"coulomb14", e.coulomb14},
            {"solvation", e.solvation},
            {"total", e.total()}};
}

// The first lines of files with a row for each atom, by which they are known again.
constexpr std::string_view force_columns =
    "segment,residue,number,atom,force_x_kcal_per_mol_angstrom,force_y_kcal_per_mol_angstrom,"
    "force_z_kcal_per_mol_angstrom\n";
constexpr std::string_view atom_columns =
    "segment,residue,number,atom,type,charge_e,solvation_kcal_per_mol\n";

// `values`: what stands behind an atom's name.
template <typename F>
std::string format_rows(std::string_view columns, const Connectivity& connectivity, F&& values) {
    std::string text(columns);
    for (std::size_t i = 0; i < connectivity.names.size(); ++i) {
        const AtomName& name = connectivity.names[i];
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", name.segment, name.residue,
                       name.number, name.atom, values(i));
    }
    return text;
}

// Charges are no part of solvation, so that those of the other model are only warned of.
void warn_of_charges(const Connectivity& connectivity, bool is_solvated) {
    const std::vector<std::string_view> types(connectivity.type.begin(), connectivity.type.end());
    if (is_solvated) {
        for (const std::string& sentence :
             find_charged(connectivity.names, types, connectivity.charge))
            fmt::print(stderr, "warning: {}, but EEF1-SB's implicit water needs neutral charges\n",
                       sentence);
        return;
    }
    const auto groups = find_ionic_groups(connectivity.names, types, connectivity.charge);
    if (const auto neutral = std::ranges::find_if(groups, &IonicGroup::has_neutral_charges);
        neutral != groups.end()) {
        fmt::print(stderr,
                   "warning: {} has EEF1-SB's neutral charges, but the energy is computed in "
                   "vacuum; expected --solvent eef1-sb\n",
                   to_string(connectivity.names[neutral->atoms.front()]));
    }
}

// Energies and forces of everything with the exact exponential; then each atom's solvation as the
// options say.
struct Energies {
    EnergyTerms terms;
    std::vector<Vec3> forces;
    std::vector<double> solvation;  // of each atom, kcal/mol; empty without a solvent
};

Energies find_energies(const EnergyOptions& options, const Topology& topology,
                       const NonbondedSettings& settings, std::span<const Vec3> positions) {
    const auto exponential = static_cast<SolvationExponential>(
        choice_called("--solvent-exp", options.solvent_exp.value_or("exact"), exponential_names));
    Energies found{{}, std::vector<Vec3>(positions.size(), Vec3::Zero()), {}};
    found.terms = add_forces(topology, settings, positions, found.forces);
    if (settings.solvation == SolvationEnd::None) return found;
    found.solvation = find_solvation_energies(topology, settings.solvation, positions, exponential);
    found.terms.solvation = std::accumulate(found.solvation.begin(), found.solvation.end(), 0.0);
    return found;
}

Topology build_solvated_topology(const EnergyOptions& options, const Connectivity& connectivity,
                                 const ForceField& force_field) {
    Topology topology = build_topology(connectivity, force_field);
    warn_of_charges(connectivity, options.solvent != "none");
    if (options.solvent == "none") return topology;
    const SolvationTable table = options.solvent_table
                                     ? parse_solvation_table(read_text_file(*options.solvent_table),
                                                             options.solvent_table->string())
                                     : eef1sb_table();
    std::vector<std::uint8_t> is_structural;
    if (options.structural_water) {
        is_structural = find_water_atoms(connectivity.names, connectivity.mass);
        if (std::ranges::find(is_structural, 1) == is_structural.end()) {
            throw LoadError({"--structural-water"},
                            "this system has no water; expected a system with waters");
        }
    }
    topology.solvation = assign_solvation(connectivity, force_field, table, is_structural);
    return topology;
}

Existing check_written(const std::optional<std::filesystem::path>& path, std::string_view columns,
                       bool overwrites) {
    return path ? check_output(*path, columns, overwrites) : Existing::Refuse;
}

}  // namespace

int energy_command(const EnergyOptions& options) {
    const NonbondedSettings settings = build_settings(options);
    const bool is_psf = options.system.extension() == ".psf";
    if (is_psf && !options.coordinates) {
        throw LoadError({options.system.string()},
                        "a PSF has no coordinates; expected --coordinates FILE with it");
    }
    const Existing forces = check_written(options.forces, force_columns, options.overwrites);
    const Existing atoms = check_written(options.per_atom, atom_columns, options.overwrites);
    ForceField force_field = read_force_field(expand_folders(options.toppar));
    const std::vector<ForceFieldNote> notes = force_field.notes;
    if (!options.json) warn_of_notes(force_field);
    // As scenes have it: Asp's type changes with its charges, and an NBFIX goes.
    if (settings.solvation != SolvationEnd::None)
        force_field = neutralise_ionic_groups(std::move(force_field));
    const Structure structure = read_structure(is_psf ? *options.coordinates : options.system);
    const Connectivity connectivity =
        is_psf ? read_psf(options.system) : type_structure(force_field, structure);
    const std::vector<Vec3> positions = match_positions(
        connectivity, options.coordinates ? read_structure(*options.coordinates) : structure);
    warn_of_coincident_atoms(connectivity, positions);
    const Topology topology = build_solvated_topology(options, connectivity, force_field);
    const Energies found = find_energies(options, topology, settings, positions);
    const EnergyTerms& energy = found.terms;
    if (options.forces)
        write_text_file(*options.forces,
                        format_rows(force_columns, connectivity,
                                    [&](std::size_t i) {
                                        const Vec3& f = found.forces[i];
                                        return fmt::format("{},{},{}", f.x(), f.y(), f.z());
                                    }),
                        forces);
    if (options.per_atom)
        write_text_file(*options.per_atom,
                        format_rows(atom_columns, connectivity,
                                    [&](std::size_t i) {
                                        return fmt::format("{},{},{}", connectivity.type[i],
                                                           connectivity.charge[i],
                                                           found.solvation[i]);
                                    }),
                        atoms);
    if (options.json) {
        nlohmann::ordered_json json;
        for (const auto& [name, value] : list_terms(energy)) json[name] = value;
        for (const ForceFieldNote& note : notes) json["warnings"].push_back(describe_note(note));
        fmt::print("{}\n", json.dump(2));
        return 0;
    }
    fmt::print("{} atoms, kcal/mol\n", positions.size());
    for (const auto& [name, value] : list_terms(energy)) {
        fmt::print("  {:<14}{}\n", name, format_energy(value));
    }
    return 0;
}

void add_energy(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& energy = *program.add_subcommand("energy", "Print energies term by term, and forces");
    EnergyOptions& options = own_options<EnergyOptions>(energy, chosen, energy_command);
    describe(energy,
             {"palpa energy system.psf --coordinates system.crd --toppar top_all36_prot.rtf "
              "par_all36m_prot.prm",
              "palpa energy solvent.psf --coordinates solvent.crd --toppar system.prm solvent.prm "
              "--solvent eef1-sb --per-atom atoms.csv"});
    energy.add_option("system", options.system, "PSF file, or a structure file with all atoms")
        ->required();
    energy
        .add_option("--coordinates", options.coordinates,
                    "coordinates for a PSF: .crd, .pdb or .cif")
        ->type_name("FILE");
    add_toppar_option(energy, options.toppar);
    energy.add_option("--method", options.method, "all-pairs or cutoff (default all-pairs)")
        ->type_name("NAME");
    energy
        .add_option("--solvent", options.solvent,
                    "none, or eef1-sb: implicit water with neutral ionic groups and a dielectric "
                    "of 1.5 times the distance in Å (default none)")
        ->type_name("NAME");
    energy
        .add_option("--solvent-end", options.solvent_end,
                    "smooth: cutoffs as in scenes; sharp: solvation is cut at 9 Å as in CHARMM, "
                    "other pairs as --method says (default smooth)")
        ->type_name("NAME");
    energy
        .add_option("--solvent-exp", options.solvent_exp,
                    "exact, or table: solvation energy (not forces) from the table that CHARMM "
                    "used until 2013 (default exact)")
        ->type_name("NAME");
    energy
        .add_option(
            "--solvent-table", options.solvent_table,
            "CSV file with solvation parameters by atom type, in place of the built-in ones")
        ->type_name("FILE");
    energy.add_flag("--structural-water", options.structural_water,
                    "count waters as part of the structure, without volume or solvation energy");
    energy
        .add_option("--per-atom", options.per_atom,
                    "write the solvation energy of every atom to this CSV file")
        ->type_name("FILE");
    energy
        .add_option("--coulomb-constant", options.coulomb_constant,
                    "Coulomb's constant, kcal Å/mol/e^2 (default 332.0716, CHARMM's)")
        ->check(in_range(0.0, 1e6));
    energy
        .add_option("--dielectric", options.dielectric,
                    "relative dielectric constant (default 1, with implicit water 1.5)")
        ->check(in_range(1e-6, 1e6));
    energy.add_flag("--distance-dielectric", options.distance_dielectric,
                    "multiply the dielectric by the distance in Å");
    energy.add_option("--cutoff", options.cutoff, "cutoff distance, Å (default 12)")
        ->check(in_range(0.0, 1e6));
    energy
        .add_option("--switch-from", options.switch_from,
                    "distance where switching begins, Å (default 10)")
        ->check(in_range(0.0, 1e6));
    energy.add_option("--electrostatics", options.electrostatics,
                      "with a cutoff: shift, switch, fshift or fswitch (default fshift)");
    energy.add_option("--van-der-waals", options.van_der_waals,
                      "with a cutoff: switch or fswitch (default switch)");
    energy
        .add_option("--forces", options.forces,
                    "write the force on every atom, kcal/mol/Å, to this CSV file")
        ->type_name("FILE");
    add_overwrite_flag(energy, options.overwrites);
    energy.add_flag("--json", options.json, "print JSON");
}

}  // namespace palpa
