#include "inputs/lammps.h"

#include "core/load_error.h"
#include "inputs/molecules.h"
#include "math/angles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

// kcal Å/mol/e^2: LAMMPS's own of its units "real", and that of its styles charmmfsw.
constexpr double lammps_coulomb_constant = 332.06371, charmmfsw_coulomb_constant = 332.0716;
// Of fix cmap.
constexpr std::size_t most_maps = 6, map_size = 24;

double lammps_sigma(double rmin) { return rmin / std::pow(2.0, 1.0 / 6.0); }

[[noreturn]] void refuse(const RunSystem& system, std::uint32_t atom, const std::string& what) {
    throw LoadError(
        {system.connectivity.file, system.connectivity.lines[atom]},
        fmt::format("the {} that begins at {}", what, to_string(system.connectivity.names[atom])));
}

// Terms of one kind: those of the same numbers have one type.
class TermList {
public:
    // `numbers` is how the type's line ends.
    int add(const std::string& numbers, const std::vector<std::uint32_t>& atoms) {
        const auto [known, is_new] =
            types_.try_emplace(numbers, static_cast<int>(lines_.size()) + 1);
        if (is_new) lines_.push_back(numbers);
        ++count_;
        rows_ += fmt::format("{} {}", count_, known->second);
        for (const std::uint32_t atom : atoms) rows_ += fmt::format(" {}", atom + 1);
        rows_ += '\n';
        return known->second;
    }

    std::size_t count() const { return count_; }
    std::size_t types() const { return lines_.size(); }

    // Sections "Bond Coeffs" and "Bonds".
    std::string format(std::string_view name) const {
        if (count_ == 0) return {};
        std::string text = fmt::format("\n{} Coeffs\n\n", name);
        for (std::size_t i = 0; i < lines_.size(); ++i)
            text += fmt::format("{} {}\n", i + 1, lines_[i]);
        return text + fmt::format("\n{}s\n\n", name) + rows_;
    }

private:
    std::map<std::string, int> types_;
    std::vector<std::string> lines_;
    std::string rows_;
    std::size_t count_ = 0;
};

struct Terms {
    TermList bonds, angles, dihedrals, impropers;
    // Types that fix shake takes.
    std::set<int> rigid_bonds, rigid_angles;
};

void add_bonds(const RunSystem& system, const std::vector<bool>& is_rigid_water, Terms& terms) {
    const auto& mass = system.connectivity.mass;
    for (const Bond& t : system.topology.bonds) {
        // Between the hydrogens of a rigid water, where the angle stands for it.
        if (is_rigid_water[t.a] && is_hydrogen(mass[t.a]) && is_hydrogen(mass[t.b]) && t.k == 0)
            continue;
        const bool is_rigid = t.k > 0 && (is_hydrogen(mass[t.a]) || is_hydrogen(mass[t.b]));
        const int type = terms.bonds.add(
            fmt::format("{:.12g} {:.12g}{}", t.k, t.r0, is_rigid ? " # to hydrogen" : ""),
            {t.a, t.b});
        if (is_rigid) terms.rigid_bonds.insert(type);
    }
}

void add_angles(const RunSystem& system, const std::vector<bool>& is_rigid_water, Terms& terms) {
    std::multimap<std::array<std::uint32_t, 2>, const UreyBradley*> urey_bradley_of;
    for (const UreyBradley& t : system.topology.urey_bradleys)
        urey_bradley_of.emplace(std::array{std::min(t.a, t.c), std::max(t.a, t.c)}, &t);
    for (const Angle& t : system.topology.angles) {
        double k = 0, s0 = 0;
        const auto with = urey_bradley_of.find({std::min(t.a, t.c), std::max(t.a, t.c)});
        if (with != urey_bradley_of.end()) {
            k = with->second->k;
            s0 = with->second->s0;
            urey_bradley_of.erase(with);
        }
        const int type = terms.angles.add(
            fmt::format("{:.12g} {:.12g} {:.12g} {:.12g}{}", t.k, t.theta0 * degrees_per_radian, k,
                        s0, is_rigid_water[t.b] ? " # of water" : ""),
            {t.a, t.b, t.c});
        if (is_rigid_water[t.b]) terms.rigid_angles.insert(type);
    }
}

// The two atoms between two that are three bonds apart.
std::array<std::uint32_t, 2> find_between(const std::vector<std::vector<std::uint32_t>>& bonded,
                                          std::uint32_t a, std::uint32_t d) {
    for (const std::uint32_t b : bonded[a])
        for (const std::uint32_t c : bonded[b])
            if (std::ranges::find(bonded[c], d) != bonded[c].end()) return {b, c};
    return {a, d};  // no pair of a topology
}

// LAMMPS reckons the pairs three bonds apart with dihedrals, each by a weight: of the dihedrals
// over a pair the first has all of it.
void add_dihedrals(const RunSystem& system, Terms& terms) {
    const Topology& topology = system.topology;
    std::set<std::array<std::uint32_t, 2>> left(topology.exclusions.pairs14.begin(),
                                                topology.exclusions.pairs14.end());
    for (const Dihedral& t : topology.dihedrals) {
        const double phase = t.phase * degrees_per_radian, whole = std::round(phase);
        if (std::abs(phase - whole) > 1e-6) {
            refuse(system, t.a,
                   fmt::format("dihedral has a phase of {:.6g} degrees; expected whole degrees, as "
                               "LAMMPS requires",
                               phase));
        }
        const bool has_pair = left.erase({std::min(t.a, t.d), std::max(t.a, t.d)}) == 1;
        terms.dihedrals.add(fmt::format("{:.12g} {} {:.0f} {}", t.k, t.multiplicity, whole,
                                        has_pair ? "1.0" : "0.0"),
                            {t.a, t.b, t.c, t.d});
    }
    std::vector<std::vector<std::uint32_t>> bonded(topology.size());
    for (const Bond& bond : topology.bonds) {
        bonded[bond.a].push_back(bond.b);
        bonded[bond.b].push_back(bond.a);
    }
    for (const auto& [a, d] : left) {
        const auto [b, c] = find_between(bonded, a, d);
        terms.dihedrals.add("0.0 1 0 1.0", {a, b, c, d});
    }
}

void add_impropers(const RunSystem& system, Terms& terms) {
    for (const Improper& t : system.topology.impropers) {
        const double psi0 = std::abs(t.psi0 * degrees_per_radian);
        if (std::min(psi0, std::abs(psi0 - 180)) > 1e-6) {
            refuse(system, t.a,
                   fmt::format("improper is at {:.6g} degrees; expected 0 or 180, because LAMMPS "
                               "does not distinguish the two sides",
                               psi0));
        }
        terms.impropers.add(fmt::format("{:.12g} {:.12g}", t.k, psi0), {t.a, t.b, t.c, t.d});
    }
}

std::vector<bool> find_rigid_waters(const RunSystem& system) {
    std::vector<bool> is_rigid(system.positions.size(), false);
    for (const MoleculeTerms& molecule : split_molecules(system.topology)) {
        if (!find_rigid_water(system, molecule)) continue;
        for (std::uint32_t i = 0; i < 3; ++i) is_rigid[molecule.atoms.first + i] = true;
    }
    return is_rigid;
}

Terms list_terms_of(const RunSystem& system) {
    Terms terms;
    const std::vector<bool> is_rigid_water = find_rigid_waters(system);
    add_bonds(system, is_rigid_water, terms);
    add_angles(system, is_rigid_water, terms);
    add_dihedrals(system, terms);
    add_impropers(system, terms);
    return terms;
}

// LAMMPS has a mass for each type of atom, and some force fields have several for one.
struct AtomKinds {
    std::vector<std::pair<std::uint32_t, double>> kinds;  // Lennard-Jones type, mass
    std::vector<int> of;                                  // each atom's, from 1
};

AtomKinds find_kinds(const RunSystem& system) {
    AtomKinds result;
    std::map<std::pair<std::uint32_t, double>, int> known;
    for (std::size_t i = 0; i < system.positions.size(); ++i) {
        const std::pair kind{system.topology.type[i], system.connectivity.mass[i]};
        const auto [at, is_new] = known.try_emplace(kind, static_cast<int>(known.size()) + 1);
        if (is_new) result.kinds.push_back(kind);
        result.of.push_back(at->second);
    }
    return result;
}

std::string format_edges(const RunSystem& system) {
    constexpr double margin = 1;  // Å
    Extent extent{Vec3::Zero(), system.box.value_or(Vec3(Vec3::Zero()))};
    if (!system.box) {
        extent = find_extent(system.positions);
        extent.low.array() -= margin;
        extent.high.array() += margin;
    }
    std::string text;
    for (int axis = 0; axis < 3; ++axis)
        text += fmt::format("{0:.10g} {1:.10g} {2}lo {2}hi\n", extent.low[axis], extent.high[axis],
                            "xyz"[axis]);
    return text;
}

std::string format_atoms(const RunSystem& system, const AtomKinds& kinds) {
    const std::vector<std::uint32_t> molecule = find_molecules(system.topology);
    std::string text = "\nAtoms # full\n\n";
    for (std::size_t i = 0; i < system.positions.size(); ++i) {
        Vec3 place = system.positions[i], image = Vec3::Zero();
        if (system.box) {
            image = place.cwiseQuotient(*system.box).array().floor();
            place -= image.cwiseProduct(*system.box);
        }
        text += fmt::format("{} {} {} {:.12g} {:.10f} {:.10f} {:.10f} {:.0f} {:.0f} {:.0f}\n",
                            i + 1, molecule[i] + 1, kinds.of[i], system.topology.charge[i],
                            place.x(), place.y(), place.z(), image.x(), image.y(), image.z());
    }
    return text;
}

std::string format_crossterms(const RunSystem& system) {
    const auto& terms = system.topology.cmap_terms;
    if (terms.empty()) return {};
    std::string text = "\nCMAP\n\n";
    for (std::size_t i = 0; i < terms.size(); ++i) {
        text += fmt::format("{} {}", i + 1, terms[i].map + 1);
        for (const std::uint32_t atom : five_atoms(system, terms[i]))
            text += fmt::format(" {}", atom + 1);
        text += '\n';
    }
    return text;
}

std::string format_data(const RunSystem& system, const Terms& terms, const AtomKinds& kinds) {
    std::string text =
        fmt::format("{}; by palpa engine\n\n{} atoms\n", system.title, system.positions.size());
    const std::array<std::pair<std::string_view, const TermList*>, 4> lists{
        {{"bond", &terms.bonds},
         {"angle", &terms.angles},
         {"dihedral", &terms.dihedrals},
         {"improper", &terms.impropers}}};
    for (const auto& [name, list] : lists) text += fmt::format("{} {}s\n", list->count(), name);
    if (!system.topology.cmap_terms.empty())
        text += fmt::format("{} crossterms\n", system.topology.cmap_terms.size());
    text += fmt::format("\n{} atom types\n", kinds.kinds.size());
    for (const auto& [name, list] : lists)
        text += fmt::format("{} {} types\n", list->types(), name);
    text += "\n" + format_edges(system) + "\nMasses\n\n";
    const std::vector<std::string> names = name_types(system);
    for (std::size_t i = 0; i < kinds.kinds.size(); ++i) {
        const auto& [type, mass] = kinds.kinds[i];
        text += fmt::format("{} {:.10g} # {}\n", i + 1, mass, names[type]);
    }
    return text + format_atoms(system, kinds) + terms.bonds.format("Bond") +
           terms.angles.format("Angle") + terms.dihedrals.format("Dihedral") +
           terms.impropers.format("Improper") + format_crossterms(system);
}

std::string format_grids(const RunSystem& system) {
    const auto& maps = system.topology.cmap_maps;
    const bool fits = maps.size() <= most_maps && std::ranges::all_of(maps, [](const CmapMap& m) {
                          return m.size == map_size;
                      });
    if (!fits) {
        throw LoadError({system.connectivity.file},
                        fmt::format("has {} maps of cross-terms; LAMMPS takes at most {}, of {} x "
                                    "{} points",
                                    maps.size(), most_maps, map_size, map_size));
    }
    std::string text = "# Maps of cross-terms, kcal/mol, by palpa engine.\n";
    for (std::size_t i = 0; i < most_maps; ++i) {
        text += fmt::format("\n# {}\n", i < maps.size() ? fmt::format("map {}", i + 1)
                                                        : "not used: LAMMPS reads six");
        for (std::size_t at = 0; at < map_size * map_size; ++at) {
            text += fmt::format("{:.10g}{}", i < maps.size() ? maps[i].points[at].energy : 0.0,
                                at % 6 == 5 ? '\n' : ' ');
        }
    }
    return text;
}

std::string pair_numbers(const LennardJonesPair& plain, const LennardJonesPair& near) {
    return fmt::format("{:.12g} {:.12g} {:.12g} {:.12g}", plain.epsilon, lammps_sigma(plain.rmin),
                       near.epsilon, lammps_sigma(near.rmin));
}

// Of all pairs of types whose numbers are not combined, and of each type with itself.
std::string format_pair_numbers(const RunSystem& system, const AtomKinds& kinds) {
    const LennardJonesTable &plain = system.topology.lennard_jones,
                            &near = system.topology.lennard_jones14;
    std::set<std::array<std::uint32_t, 2>> uncombined;
    for (const LennardJonesTable* table : {&plain, &near})
        for (const auto& pair : find_uncombined(*table)) uncombined.insert(pair);
    const std::vector<std::string> names = name_types(system);
    std::string text =
        "# epsilon, sigma, and both of pairs three bonds apart; others by CHARMM's rules\n";
    for (std::size_t i = 0; i < kinds.kinds.size(); ++i) {
        for (std::size_t j = i; j < kinds.kinds.size(); ++j) {
            const std::uint32_t a = kinds.kinds[i].first, b = kinds.kinds[j].first;
            if (i != j && a != b && !uncombined.contains({std::min(a, b), std::max(a, b)}))
                continue;
            text += fmt::format("pair_coeff {} {} {} # {} {}\n", i + 1, j + 1,
                                pair_numbers(plain.row(a)[b], near.row(a)[b]), names[a], names[b]);
        }
    }
    return text;
}

std::string format_styles(const RunSystem& system, const Terms& terms) {
    std::string text =
        fmt::format("units real\natom_style full\nboundary {}\n", system.box ? "p p p" : "s s s");
    if (terms.bonds.count() > 0) text += "bond_style harmonic\n";
    if (terms.angles.count() > 0) text += "angle_style charmm\n";
    if (terms.dihedrals.count() > 0)
        text += fmt::format("dihedral_style {}\n", system.box ? "charmmfsw" : "charmm");
    if (terms.impropers.count() > 0) text += "improper_style harmonic\n";
    if (system.box) {
        text += "pair_style lj/charmmfsw/coul/long 10.0 12.0\nkspace_style pppm 1e-5\n";
    } else {
        const double reach = find_reach(system.positions);
        text += fmt::format("pair_style lj/charmm/coul/charmm {:.1f} {:.1f} # all pairs\n", reach,
                            reach + 1);
    }
    const double own = system.box ? charmmfsw_coulomb_constant : lammps_coulomb_constant;
    return text + fmt::format(
                      "pair_modify mix arithmetic\nspecial_bonds charmm\n"
                      "# the Coulomb constant is {:.7g} kcal A/mol/e^2, that of these "
                      "styles {:.8g}\ndielectric {:.12g}\n",
                      system.coulomb_constant, own, own / system.coulomb_constant);
}

// "1:62 70", as LAMMPS names atoms.
std::string format_ids(const std::vector<std::uint32_t>& atoms) {
    std::string text;
    for (std::size_t i = 0; i < atoms.size();) {
        std::size_t end = i + 1;
        while (end < atoms.size() && atoms[end] == atoms[end - 1] + 1) ++end;
        text += fmt::format(" {}:{}", atoms[i] + 1, atoms[end - 1] + 1);
        i = end;
    }
    return text;
}

std::string format_input(const RunSystem& system, const EngineRunOptions& options,
                         const Terms& terms, const AtomKinds& kinds) {
    const bool has_maps = !system.topology.cmap_terms.empty();
    constexpr std::int64_t most_steps = 2'000'000'000;  // of one command, in 32 bits
    std::string text = fmt::format(
        "# {}. Written by palpa engine.\nvariable port index {}\nvariable steps index {}\n"
        "variable rigid index {}\n\n",
        system.title, options.port,
        options.steps < 0 ? most_steps : std::min(options.steps, most_steps),
        options.flexible ? 0 : 1);
    text += format_styles(system, terms);
    if (has_maps) text += "fix maps all cmap system.cmap\nfix_modify maps energy yes\n";
    text += fmt::format("read_data system.data{}\n", has_maps ? " fix maps crossterm CMAP" : "");
    text += format_pair_numbers(system, kinds);
    // In vacuum all others; LAMMPS has room for 2000 unless set otherwise.
    const std::size_t neighbours = std::max<std::size_t>(2000, system.positions.size());
    text += fmt::format(
        "\nneighbor 2.0 bin\nneigh_modify every 1 delay 0 check yes one {} page {}\ntimestep "
        "{:.6g}\n"
        "thermo_style custom step temp pe ebond eangle edihed eimp evdwl ecoul elong{}\n"
        "thermo_modify format float %.14g\nthermo 100\ngroup sent {}\n",
        neighbours, 10 * neighbours, timestep_of(options), has_maps ? " f_maps" : "",
        options.sent.empty() ? std::string("union all") : "id" + format_ids(options.sent));
    text +=
        fmt::format("fix heat all langevin {0:.6g} {0:.6g} 1000 20 zero yes\nfix move all nve\n",
                    options.temperature);
    text +=
        "# forces come in only at steps at which no coordinates go out: a rate of 2\n"
        "if \"${port} > 0\" then \"fix client sent imd ${port} unwrap on trate 2\"\n";
    if (!terms.rigid_bonds.empty()) {
        text += fmt::format(
            "if \"${{rigid}} > 0\" then \"fix rigid all shake 1e-6 100 0 b {}{}\"\n",
            fmt::join(terms.rigid_bonds, " "),
            terms.rigid_angles.empty() ? std::string()
                                       : fmt::format(" a {}", fmt::join(terms.rigid_angles, " ")));
    }
    return text + fmt::format(
                      "velocity all create {:.6g} 20 mom yes rot {} dist gaussian\n"
                      "run ${{steps}}\n",
                      options.temperature, system.box ? "no" : "yes");
}

std::string format_start_line(const EngineRunOptions& options) {
    return fmt::format(
        "#!/bin/sh\n# Starts LAMMPS, which waits for a client at port {}. Written by "
        "palpa engine.\ncd \"$(dirname \"$0\")\" && exec ${{LAMMPS:-lmp}} -in run.in "
        "\"$@\"\n",
        options.port);
}

}  // namespace

std::vector<TextFile> format_lammps(const RunSystem& system, const EngineRunOptions& options) {
    const Terms terms = list_terms_of(system);
    const AtomKinds kinds = find_kinds(system);
    std::vector<TextFile> files{{"system.data", format_data(system, terms, kinds)},
                                {"run.in", format_input(system, options, terms, kinds)},
                                {"run.sh", format_start_line(options)}};
    if (!system.topology.cmap_terms.empty()) files.push_back({"system.cmap", format_grids(system)});
    return files;
}

}  // namespace palpa
