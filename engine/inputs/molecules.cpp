#include "inputs/molecules.h"

#include "core/load_error.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <span>

namespace palpa {
namespace {

constexpr double heaviest_hydrogen = 3.5;                     // amu: protium to tritium
constexpr double lightest_oxygen = 15, heaviest_oxygen = 19;  // amu
constexpr double combined_within = 1e-12;                     // relative, of rounding

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t atom) {
    while (parent[atom] != atom) atom = parent[atom] = parent[parent[atom]];
    return atom;
}

bool is_near(double a, double b) {
    return std::abs(a - b) <= combined_within * std::max(std::abs(a), std::abs(b));
}

// Each kind of term names its atoms in its own way.
std::uint32_t first_atom(const Bond& term) { return term.a; }
std::uint32_t first_atom(const Angle& term) { return term.a; }
std::uint32_t first_atom(const UreyBradley& term) { return term.a; }
std::uint32_t first_atom(const Dihedral& term) { return term.a; }
std::uint32_t first_atom(const Improper& term) { return term.a; }
std::uint32_t first_atom(const CmapTerm& term) { return term.phi[0]; }
std::uint32_t first_atom(const std::array<std::uint32_t, 2>& pair) { return pair[0]; }

void shift(Bond& t, std::uint32_t by) { t.a -= by, t.b -= by; }
void shift(Angle& t, std::uint32_t by) { t.a -= by, t.b -= by, t.c -= by; }
void shift(UreyBradley& t, std::uint32_t by) { t.a -= by, t.c -= by; }
void shift(Dihedral& t, std::uint32_t by) { t.a -= by, t.b -= by, t.c -= by, t.d -= by; }
void shift(Improper& t, std::uint32_t by) { t.a -= by, t.b -= by, t.c -= by, t.d -= by; }
void shift(std::array<std::uint32_t, 2>& t, std::uint32_t by) { t[0] -= by, t[1] -= by; }
void shift(CmapTerm& t, std::uint32_t by) {
    for (std::uint32_t& atom : t.phi) atom -= by;
    for (std::uint32_t& atom : t.psi) atom -= by;
}

// Terms to the molecules that they are of.
template <class Term>
void deal(const std::vector<Term>& terms, const std::vector<std::uint32_t>& molecule_of,
          std::vector<MoleculeTerms>& molecules, std::vector<Term> MoleculeTerms::* list) {
    for (Term term : terms) {
        MoleculeTerms& molecule = molecules[molecule_of[first_atom(term)]];
        shift(term, molecule.atoms.first);
        (molecule.*list).push_back(term);
    }
}

}  // namespace

std::vector<std::uint32_t> find_molecules(const Topology& topology) {
    std::vector<std::uint32_t> parent(topology.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        const std::uint32_t one = root_of(parent, a), other = root_of(parent, b);
        parent[std::max(one, other)] = std::min(one, other);
    };
    for (const Bond& bond : topology.bonds) join(bond.a, bond.b);
    for (const Angle& angle : topology.angles) join(angle.a, angle.b), join(angle.a, angle.c);
    for (const Dihedral& t : topology.dihedrals) join(t.a, t.b), join(t.a, t.c), join(t.a, t.d);
    for (const Improper& t : topology.impropers) join(t.a, t.b), join(t.a, t.c), join(t.a, t.d);
    // The root is the lowest atom, which comes first.
    std::vector<std::uint32_t> molecule(topology.size());
    std::uint32_t count = 0;
    for (std::uint32_t atom = 0; atom < parent.size(); ++atom) {
        const std::uint32_t root = root_of(parent, atom);
        molecule[atom] = root == atom ? count++ : molecule[root];
    }
    return molecule;
}

std::vector<AtomRange> list_molecules(const Topology& topology) {
    const std::vector<std::uint32_t> molecule_of = find_molecules(topology);
    std::vector<AtomRange> ranges;
    for (std::uint32_t atom = 0; atom < molecule_of.size(); ++atom) {
        if (molecule_of[atom] == ranges.size()) ranges.push_back({atom, 0});
        ++ranges.back().count;
    }
    return ranges;
}

std::vector<MoleculeTerms> split_molecules(const Topology& topology) {
    const std::vector<std::uint32_t> molecule_of = find_molecules(topology);
    std::vector<MoleculeTerms> molecules;
    for (const AtomRange& atoms : list_molecules(topology)) {
        molecules.emplace_back();
        molecules.back().atoms = atoms;
    }
    deal(topology.bonds, molecule_of, molecules, &MoleculeTerms::bonds);
    deal(topology.angles, molecule_of, molecules, &MoleculeTerms::angles);
    deal(topology.urey_bradleys, molecule_of, molecules, &MoleculeTerms::urey_bradleys);
    deal(topology.dihedrals, molecule_of, molecules, &MoleculeTerms::dihedrals);
    deal(topology.impropers, molecule_of, molecules, &MoleculeTerms::impropers);
    deal(topology.cmap_terms, molecule_of, molecules, &MoleculeTerms::cmap_terms);
    deal(topology.exclusions.pairs14, molecule_of, molecules, &MoleculeTerms::pairs14);
    return molecules;
}

bool is_hydrogen(double mass) noexcept { return mass < heaviest_hydrogen; }

std::optional<RigidWater> find_rigid_water(const RunSystem& system, const MoleculeTerms& molecule) {
    if (molecule.atoms.count != 3) return std::nullopt;
    const auto mass = std::span(system.connectivity.mass).subspan(molecule.atoms.first, 3);
    const bool is_water = mass[0] > lightest_oxygen && mass[0] < heaviest_oxygen &&
                          is_hydrogen(mass[1]) && is_hydrogen(mass[2]);
    if (!is_water || molecule.angles.size() != 1 || molecule.angles[0].b != 0) return std::nullopt;
    std::vector<double> oh;
    std::optional<double> hh;
    for (const Bond& bond : molecule.bonds) {
        if (bond.a == 0 || bond.b == 0) {
            oh.push_back(bond.r0);
        } else {
            hh = bond.r0;
        }
    }
    if (oh.size() != 2 || oh[0] != oh[1]) return std::nullopt;
    return RigidWater{oh[0], hh.value_or(2 * oh[0] * std::sin(molecule.angles[0].theta0 / 2))};
}

std::vector<std::string> name_types(const RunSystem& system) {
    std::vector<std::string> names(system.topology.lennard_jones.types);
    std::set<std::string> taken;
    for (std::size_t atom = 0; atom < system.topology.size(); ++atom) {
        std::string& name = names[system.topology.type[atom]];
        if (!name.empty()) continue;
        const std::string& called = system.connectivity.type[atom];
        // Engines read a number where a type could stand.
        const bool is_number = called.empty() || (called[0] >= '0' && called[0] <= '9');
        name = is_number ? "T" + called : called;
        while (!taken.insert(name).second) name += "X";
    }
    for (std::size_t type = 0; type < names.size(); ++type) {
        if (names[type].empty()) names[type] = fmt::format("UNUSED{}", type);
    }
    return names;
}

std::array<std::uint32_t, 5> five_atoms(const RunSystem& system, const CmapTerm& term,
                                        std::uint32_t first) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (term.phi[i + 1] == term.psi[i]) continue;
        const std::uint32_t atom = term.phi[0] + first;
        throw LoadError(
            {system.connectivity.file, system.connectivity.lines[atom]},
            fmt::format("the cross-term (CMAP) that begins at {} has two dihedrals that do not "
                        "overlap, which other engines do not support; expected the second dihedral "
                        "to begin with the last three atoms of the first",
                        to_string(system.connectivity.names[atom])));
    }
    return {term.phi[0], term.phi[1], term.phi[2], term.phi[3], term.psi[3]};
}

std::vector<std::array<std::uint32_t, 2>> find_uncombined(const LennardJonesTable& table) {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    const auto types = static_cast<std::uint32_t>(table.types);
    for (std::uint32_t a = 0; a < types; ++a) {
        for (std::uint32_t b = a + 1; b < types; ++b) {
            const LennardJonesPair &aa = table.row(a)[a], &bb = table.row(b)[b],
                                   &ab = table.row(a)[b];
            if (!is_near(ab.epsilon, std::sqrt(aa.epsilon * bb.epsilon)) ||
                !is_near(ab.rmin, 0.5 * (aa.rmin + bb.rmin))) {
                pairs.push_back({a, b});
            }
        }
    }
    return pairs;
}

}  // namespace palpa
