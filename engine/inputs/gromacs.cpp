#include "inputs/gromacs.h"

#include "core/load_error.h"
#include "formats/gro.h"
#include "inputs/molecules.h"
#include "math/angles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace palpa {
namespace {

constexpr double kj = 1 / units::kcal_per_kj;  // per kcal
constexpr double nm = 1 / units::angstrom_per_nm;
// kcal Å/mol/e^2: by CODATA 2018, as GROMACS has it, 138.935457644382 kJ nm/mol/e^2.
constexpr double gromacs_coulomb_constant = 138.935457644382 / kj / nm;

// sigma, nm, of Rmin, Å.
double sigma_of(double rmin) { return rmin * nm / std::pow(2.0, 1.0 / 6.0); }

// Twelve digits, which is more than any force field has.
std::string number(double value) { return fmt::format("{:.12g}", value); }

template <class... Numbers>
std::string row(const std::vector<std::uint32_t>& atoms, int kind, Numbers... numbers) {
    std::string text;
    for (const std::uint32_t atom : atoms) text += fmt::format("{:>5} ", atom + 1);
    text += fmt::format("{}", kind);
    ((text += fmt::format(" {:.12g}", numbers)), ...);
    text += '\n';
    return text;
}

void add_section(std::string& text, std::string_view name, const std::string& rows) {
    if (!rows.empty()) text += fmt::format("[ {} ]\n{}", name, rows);
}

std::string format_types(const RunSystem& system, const std::vector<std::string>& names) {
    const LennardJonesTable& table = system.topology.lennard_jones;
    std::string rows = "; name, bonded name, atomic number, mass, charge, kind, sigma, epsilon\n";
    for (std::uint32_t type = 0; type < names.size(); ++type) {
        const LennardJonesPair& own = table.row(type)[type];
        // Masses and charges stand with the atoms.
        rows += fmt::format("{0} {0} 0 0.0 0.0 A {1} {2}\n", names[type],
                            number(sigma_of(own.rmin)), number(own.epsilon * kj));
    }
    std::string text;
    add_section(text, "atomtypes", rows);
    rows.clear();
    for (const auto& [a, b] : find_uncombined(table)) {
        const LennardJonesPair& pair = table.row(a)[b];
        rows += fmt::format("{} {} 1 {} {}\n", names[a], names[b], number(sigma_of(pair.rmin)),
                            number(pair.epsilon * kj));
    }
    add_section(text, "nonbond_params", rows);
    return text;
}

// Maps by the types of their five atoms.
std::string format_maps(const RunSystem& system, const std::vector<std::string>& names) {
    const Topology& topology = system.topology;
    std::map<std::array<std::uint32_t, 5>, std::uint32_t> map_of;
    std::string rows;
    for (const CmapTerm& term : topology.cmap_terms) {
        std::array<std::uint32_t, 5> types = five_atoms(system, term);
        for (std::uint32_t& type : types) type = topology.type[type];
        const auto [known, is_new] = map_of.try_emplace(types, term.map);
        const CmapMap& map = topology.cmap_maps[term.map];
        if (known->second != term.map || map.size != topology.cmap_maps[0].size) {
            throw LoadError({system.connectivity.file},
                            "has cross-terms (CMAP) that GROMACS cannot distinguish: maps of "
                            "different sizes, or two maps for the same five atom types");
        }
        if (!is_new) continue;
        for (const std::uint32_t type : types) rows += names[type] + " ";
        rows += fmt::format("1 {0} {0}", map.size);
        for (std::size_t i = 0; i < map.points.size(); ++i) {
            rows += i % 8 == 0 ? "\\\n" : " ";
            rows += number(map.points[i].energy * kj);
        }
        rows += "\n";
    }
    std::string text;
    add_section(text, "cmaptypes", rows);
    return text;
}

std::string format_bonded(const RunSystem& system, const MoleculeTerms& terms) {
    const Topology& topology = system.topology;
    std::string text, rows;
    for (const Bond& t : terms.bonds) {
        // A bond without a spring (between water's hydrogens) only excludes pairs: kind 5. As kind
        // 1 it would be made rigid with the others.
        rows +=
            t.k == 0 ? row({t.a, t.b}, 5) : row({t.a, t.b}, 1, t.r0 * nm, 2 * t.k * kj / nm / nm);
    }
    add_section(text, "bonds", rows);
    rows.clear();
    for (const auto& [a, b] : terms.pairs14) {
        const std::uint32_t first = terms.atoms.first;
        const LennardJonesPair& pair =
            topology.lennard_jones14.row(topology.type[a + first])[topology.type[b + first]];
        rows += row({a, b}, 1, sigma_of(pair.rmin), pair.epsilon * kj);
    }
    add_section(text, "pairs", rows);
    rows.clear();
    std::multimap<std::array<std::uint32_t, 2>, const UreyBradley*> urey_bradley_of;
    for (const UreyBradley& t : terms.urey_bradleys)
        urey_bradley_of.emplace(std::array{std::min(t.a, t.c), std::max(t.a, t.c)}, &t);
    for (const Angle& t : terms.angles) {
        const auto with = urey_bradley_of.find({std::min(t.a, t.c), std::max(t.a, t.c)});
        if (with == urey_bradley_of.end()) {
            rows += row({t.a, t.b, t.c}, 1, t.theta0 * degrees_per_radian, 2 * t.k * kj);
            continue;
        }
        rows += row({t.a, t.b, t.c}, 5, t.theta0 * degrees_per_radian, 2 * t.k * kj,
                    with->second->s0 * nm, 2 * with->second->k * kj / nm / nm);
        urey_bradley_of.erase(with);
    }
    add_section(text, "angles", rows);
    rows.clear();
    for (const Dihedral& t : terms.dihedrals) {
        rows += row({t.a, t.b, t.c, t.d}, 9, t.phase * degrees_per_radian, t.k * kj,
                    static_cast<double>(t.multiplicity));
    }
    for (const Improper& t : terms.impropers)
        rows += row({t.a, t.b, t.c, t.d}, 2, t.psi0 * degrees_per_radian, 2 * t.k * kj);
    add_section(text, "dihedrals", rows);
    rows.clear();
    for (const CmapTerm& t : terms.cmap_terms) {
        const auto atoms = five_atoms(system, t, terms.atoms.first);
        rows += row({atoms.begin(), atoms.end()}, 1);
    }
    add_section(text, "cmap", rows);
    return text;
}

// A molecule without its name: two that read the same are alike.
std::string format_molecule(const RunSystem& system, const MoleculeTerms& terms,
                            const std::vector<std::string>& types, bool is_rigid) {
    const Topology& topology = system.topology;
    const AtomName* before = nullptr;
    std::string rows;
    int residue = 0;
    for (std::uint32_t i = 0; i < terms.atoms.count; ++i) {
        const std::uint32_t atom = terms.atoms.first + i;
        const AtomName& name = system.connectivity.names[atom];
        if (!before || !is_same_residue(*before, name)) ++residue;
        before = &name;
        rows += fmt::format("{:>5} {:<6} {:>5} {:<5} {:<5} {:>5} {:.12g} {:.12g}\n", i + 1,
                            types[topology.type[atom]], residue, name.residue, name.atom, i + 1,
                            topology.charge[atom], system.connectivity.mass[atom]);
    }
    std::string text;
    add_section(text, "atoms", rows);
    const auto water = is_rigid ? find_rigid_water(system, terms) : std::nullopt;
    if (!water) return text + format_bonded(system, terms);
    return text + "#ifdef FLEXIBLE\n" + format_bonded(system, terms) +
           fmt::format(
               "#else\n[ settles ]\n1 1 {} {}\n[ exclusions ]\n1 2 3\n2 1 3\n3 1 2\n#endif\n",
               number(water->oh * nm), number(water->hh * nm));
}

// By which molecules are called, each name once.
std::string name_molecule(const RunSystem& system, const AtomRange& atoms,
                          std::set<std::string>& taken) {
    const AtomName &first = system.connectivity.names[atoms.first],
                   &last = system.connectivity.names[atoms.first + atoms.count - 1];
    const bool is_single = is_same_residue(first, last) || first.segment.empty();
    const std::string base = is_single ? first.residue : first.segment;
    std::string name = base;
    for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", base, i);
    return name;
}

std::string format_top(const RunSystem& system) {
    const std::vector<std::string> types = name_types(system);
    std::string text = fmt::format(
        "; {}\n; Written by palpa engine. Everything of the force field stands here, in full.\n"
        "[ defaults ]\n; Lennard-Jones, sigma and epsilon, 1-4 pairs are given, whole\n"
        "1 2 no 1.0 1.0\n",
        system.title);
    text += format_types(system, types) + format_maps(system, types);
    std::map<std::string, std::string> name_of;  // by what stands of the molecule
    std::set<std::string> taken;
    std::vector<std::pair<std::string, std::size_t>> counts;
    bool has_settle = false;
    for (const MoleculeTerms& terms : split_molecules(system.topology)) {
        std::string body = format_molecule(system, terms, types, true);
        const bool settles = body.find("[ settles ]") != std::string::npos;
        // GROMACS has room for one kind of rigid water.
        if (settles && has_settle && !name_of.contains(body))
            body = format_molecule(system, terms, types, false);
        has_settle = has_settle || settles;
        const auto [known, is_new] = name_of.try_emplace(body);
        if (is_new) {
            known->second = name_molecule(system, terms.atoms, taken);
            // Atoms up to three bonds apart do not interact, but for the pairs.
            text += fmt::format("\n[ moleculetype ]\n{} 3\n{}", known->second, body);
        }
        if (counts.empty() || counts.back().first != known->second)
            counts.emplace_back(known->second, 0);
        ++counts.back().second;
    }
    text += fmt::format("\n[ system ]\n{}\n\n[ molecules ]\n", system.title);
    for (const auto& [name, count] : counts) text += fmt::format("{} {}\n", name, count);
    return text;
}

// Å; of vacuum so large that no atom sees another one twice.
Vec3 gromacs_box(const RunSystem& system) {
    if (system.box) return *system.box;
    constexpr double spare = 30;
    const double edge =
        2 * find_reach(system.positions) + find_extent(system.positions).size().maxCoeff() + spare;
    return Vec3::Constant(std::ceil(edge));
}

std::string format_places(const RunSystem& system) {
    Structure structure;
    structure.file = system.connectivity.file;
    structure.names = system.connectivity.names;
    structure.lines = system.connectivity.lines;
    structure.positions = gromacs_positions(system);
    for (AtomName& name : structure.names) {
        name.residue.resize(std::min<std::size_t>(name.residue.size(), 5));
        name.atom.resize(std::min<std::size_t>(name.atom.size(), 5));
    }
    constexpr int decimals = 9;
    return format_gro(structure, system.title + ", by palpa engine",
                      Mat3(gromacs_box(system).asDiagonal()), decimals);
}

// What both runs share.
std::string format_pairs(const RunSystem& system) {
    const double epsilon = gromacs_coulomb_constant / system.coulomb_constant;
    std::string text = fmt::format(
        "cutoff-scheme = verlet\npbc = xyz\n"
        "; the Coulomb constant is {:.7g} kcal A/mol/e^2, GROMACS's own {:.9g}\n"
        "epsilon-r = {:.12g}\n",
        system.coulomb_constant, gromacs_coulomb_constant, epsilon);
    if (system.box) {
        const Cutoff cutoff = gromacs_cutoff(system);
        return text + fmt::format(
                          "coulombtype = pme\nvdwtype = cut-off\n"
                          "vdw-modifier = force-switch\nrvdw-switch = {:.3f}\n"
                          "rvdw = {:.3f}\nrcoulomb = {:.3f}\nDispCorr = no\n",
                          cutoff.from * nm, cutoff.to * nm, cutoff.to * nm);
    }
    // Beyond all atoms, where a cutoff takes and shifts nothing: vacuum.
    const double reach = find_reach(system.positions) * nm;
    return text + fmt::format(
                      "coulombtype = cut-off\nepsilon-rf = {0:.12g}\n"
                      "coulomb-modifier = none\nvdwtype = cut-off\nvdw-modifier = none\n"
                      "verlet-buffer-tolerance = -1\nrcoulomb = {1:.3f}\nrvdw = {1:.3f}\n"
                      "rlist = {1:.3f}\n",
                      epsilon, reach);
}

// Waters as the force field has them. GROMACS warns of a word that the topology does not have.
std::string_view flexible_waters(std::string_view top) {
    return top.find("FLEXIBLE") == std::string_view::npos ? "" : "define = -DFLEXIBLE\n";
}

std::string format_run(const RunSystem& system, const EngineRunOptions& options,
                       std::string_view top) {
    return fmt::format(
               "; {}: dynamics. Written by palpa engine.\nintegrator = md\ndt = {:.6g}\n"
               "nsteps = {}\n{}nstlist = 20\nnstcalcenergy = 20\nnstenergy = 500\nnstlog = 500\n"
               "nstxout-compressed = 500\n",
               system.title, timestep_of(options) * 1e-3, options.steps,
               options.flexible ? fmt::format("{}constraints = none\n", flexible_waters(top))
                                : "constraints = h-bonds\n") +
           format_pairs(system) +
           fmt::format(
               "tcoupl = v-rescale\ntc-grps = System\ntau-t = 0.5\nref-t = {0:.6g}\n"
               "gen-vel = yes\ngen-temp = {0:.6g}\ngen-seed = 20\nld-seed = 20\n"
               "; what a client sees and pulls\nIMD-group = sent\n",
               options.temperature);
}

std::string format_single_point(const RunSystem& system, std::string_view top) {
    return fmt::format(
               "; {}: energies of the places of a file. Written by palpa engine.\n"
               "integrator = md\nnsteps = 0\ncontinuation = yes\n{}constraints = none\n"
               "nstlist = 1\nnstcalcenergy = 1\nnstenergy = 1\ncomm-mode = none\n",
               system.title, flexible_waters(top)) +
           format_pairs(system);
}

void add_group(std::string& text, std::string_view name, const std::vector<std::uint32_t>& atoms) {
    text += fmt::format("[ {} ]\n", name);
    for (std::size_t i = 0; i < atoms.size(); ++i)
        text +=
            fmt::format("{}{}", atoms[i] + 1, i % 15 == 14 || i + 1 == atoms.size() ? '\n' : ' ');
}

std::string format_index(const RunSystem& system, const EngineRunOptions& options) {
    std::vector<std::uint32_t> all(system.positions.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    std::string text = "; Written by palpa engine.\n";
    add_group(text, "System", all);
    add_group(text, "sent", options.sent.empty() ? all : options.sent);
    return text;
}

std::string format_start(const EngineRunOptions& options) {
    return fmt::format(
        "#!/bin/sh\n# Starts GROMACS, which waits for a client at port {0}. Written by palpa "
        "engine.\n"
        "cd \"$(dirname \"$0\")\" && ${{GMX:-gmx}} grompp -f run.mdp -c system.gro -p system.top "
        "-n "
        "index.ndx -o run.tpr -po run-all.mdp -maxwarn 1 && exec ${{GMX:-gmx}} mdrun -s run.tpr "
        "-deffnm run -imdport {0} -imdwait -imdpull -imdterm \"$@\"\n",
        options.port);
}

}  // namespace

Cutoff gromacs_cutoff(const RunSystem& system) {
    // CHARMM36's; half of the box must have room for the list's buffer as well.
    constexpr double from = 10, to = 12, buffer = 1, width = 2,
                     least = 0.5 * shortest_gromacs_edge - buffer;
    const double room = std::floor(10 * (0.5 * system.box->minCoeff() - buffer)) / 10;
    if (room < least) {
        throw LoadError({system.connectivity.file},
                        fmt::format("the shortest edge of the box is {:.2f} Å, too short for a "
                                    "cutoff; expected at least {} Å",
                                    system.box->minCoeff(), shortest_gromacs_edge));
    }
    return room >= to ? Cutoff{from, to} : Cutoff{room - width, room};
}

std::vector<Vec3> gromacs_positions(const RunSystem& system) {
    const Extent extent = find_extent(system.positions);
    std::vector<Vec3> positions = system.positions;
    // In a box GROMACS puts atoms where they belong by itself.
    const Vec3 move =
        system.box ? Vec3(Vec3::Zero()) : Vec3(0.5 * gromacs_box(system) - extent.centre());
    for (Vec3& position : positions) position += move;
    return positions;
}

std::vector<TextFile> format_gromacs(const RunSystem& system, const EngineRunOptions& options) {
    const std::string top = format_top(system);
    std::vector<TextFile> files{{"system.gro", format_places(system)},
                                {"system.top", top},
                                {"run.mdp", format_run(system, options, top)},
                                {"index.ndx", format_index(system, options)},
                                {"run.sh", format_start(options)}};
    if (!system.box) files.push_back({"energy.mdp", format_single_point(system, top)});
    return files;
}

}  // namespace palpa
