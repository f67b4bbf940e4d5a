#include "tools/commands/energy.h"

#include "charmm/build_topology.h"
#include "charmm/force_field.h"
#include "charmm/type_structure.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "forces/force_field.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "molecule/coincident_atoms.h"
#include "molecule/match_atoms.h"
#include "tools/commands/choice.h"
#include "tools/commands/command.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
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

// Å. No two nuclei are that close; the shortest bonds, to hydrogen, are ten times as long.
constexpr double coincident_distance = 0.1;
constexpr std::size_t most_warnings = 8;

NonbondedSettings build_settings(const EnergyOptions& options) {
    NonbondedSettings settings = options.nonbonded;
    if (choice_called("--method", options.method, method_names) == 1) {
        settings.cutoff = options.cutoff.value_or(settings.cutoff);
        settings.switch_from = options.switch_from.value_or(settings.switch_from);
        settings.electrostatics = static_cast<ElectrostaticCutoff>(
            1 + choice_called("--electrostatics", options.electrostatics.value_or("fshift"),
                              electrostatic_names));
        settings.van_der_waals = static_cast<VanDerWaalsCutoff>(
            1 + choice_called("--van-der-waals", options.van_der_waals.value_or("switch"),
                              van_der_waals_names));
    } else if (options.cutoff || options.switch_from || options.electrostatics ||
               options.van_der_waals) {
        throw LoadError({"--method " + options.method},
                        "--cutoff, --switch-from, --electrostatics and --van-der-waals are of a "
                        "cutoff; expected --method cutoff with them");
    }
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

// The first line of a file of forces, by which it is known again.
constexpr std::string_view force_columns =
    "segment,residue,number,atom,force_x_kcal_per_mol_angstrom,force_y_kcal_per_mol_angstrom,"
    "force_z_kcal_per_mol_angstrom\n";

std::string format_forces(const Connectivity& connectivity, std::span<const Vec3> forces) {
    std::string text(force_columns);
    for (std::size_t i = 0; i < forces.size(); ++i) {
        const AtomName& name = connectivity.names[i];
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{}\n", name.segment,
                       name.residue, name.number, name.atom, forces[i].x(), forces[i].y(),
                       forces[i].z());
    }
    return text;
}

}  // namespace

int energy_command(const EnergyOptions& options) {
    const NonbondedSettings settings = build_settings(options);
    const bool is_psf = options.system.extension() == ".psf";
    if (is_psf && !options.coordinates) {
        throw LoadError({options.system.string()},
                        "a PSF holds no coordinates; expected --coordinates FILE with it");
    }
    const Existing existing = options.forces
                                  ? check_output(*options.forces, force_columns, options.overwrites)
                                  : Existing::Refuse;
    const ForceField force_field = read_force_field(options.toppar);
    const Structure structure = read_structure(is_psf ? *options.coordinates : options.system);
    const Connectivity connectivity =
        is_psf ? read_psf(options.system) : type_structure(force_field, structure);
    const std::vector<Vec3> positions = match_positions(
        connectivity, options.coordinates ? read_structure(*options.coordinates) : structure);
    warn_of_coincident_atoms(connectivity, positions);
    const Topology topology = build_topology(connectivity, force_field);

    std::vector<Vec3> forces(positions.size(), Vec3::Zero());
    const EnergyTerms energy = add_forces(topology, settings, positions, forces);

    if (options.forces) {
        write_text_file(*options.forces, format_forces(connectivity, forces), existing);
    }
    if (options.json) {
        nlohmann::ordered_json json;
        for (const auto& [name, value] : list_terms(energy)) json[name] = value;
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
    CLI::App& energy = *program.add_subcommand("energy", "Energies term by term, and forces");
    EnergyOptions& options = own_options<EnergyOptions>(energy, chosen, energy_command);
    describe(energy, "Look and measure",
             {"palpa energy system.psf --coordinates system.crd --toppar top_all36_prot.rtf "
              "par_all36m_prot.prm"});
    energy.add_option("system", options.system, "PSF, or a structure that has all its atoms")
        ->required();
    energy.add_option("--coordinates", options.coordinates, "of a PSF: .crd, .pdb or .cif")
        ->type_name("FILE");
    add_toppar_option(energy, options.toppar);
    energy.add_option("--method", options.method, "all-pairs, or cutoff (all-pairs unless given)")
        ->type_name("NAME");
    energy
        .add_option("--coulomb-constant", options.nonbonded.coulomb_constant,
                    "kcal Å/mol/e^2, CHARMM's 332.0716 unless given")
        ->check(in_range(0.0, 1e6));
    energy.add_option("--dielectric", options.nonbonded.dielectric, "1 unless given")
        ->check(in_range(1e-6, 1e6));
    energy.add_flag("--distance-dielectric", options.nonbonded.distance_dielectric,
                    "a dielectric of that times the distance in Å");
    energy.add_option("--cutoff", options.cutoff, "Å, 12 unless given")->check(in_range(0.0, 1e6));
    energy.add_option("--switch-from", options.switch_from, "Å, 10 unless given")
        ->check(in_range(0.0, 1e6));
    energy.add_option("--electrostatics", options.electrostatics,
                      "with cutoff: shift, switch, fshift or fswitch (fshift unless given)");
    energy.add_option("--van-der-waals", options.van_der_waals,
                      "with cutoff: switch or fswitch (switch unless given)");
    energy
        .add_option("--forces", options.forces, "CSV file for the force on every atom, kcal/mol/Å")
        ->type_name("FILE");
    add_overwrite_flag(energy, options.overwrites);
    energy.add_flag("--json", options.json, "print JSON");
}

}  // namespace palpa
