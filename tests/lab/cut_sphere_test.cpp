#include "tools/lab/bench/cut_sphere.h"

#include "charmm/build_topology.h"
#include "charmm/force_field.h"
#include "core/units.h"
#include "forces/bonded.h"
#include "forces/cmap.h"
#include "forces/force_field.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "molecule/match_atoms.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Matchers::WithinRel;

namespace {

using Atoms = std::vector<std::uint32_t>;

struct Whole {
    Connectivity connectivity;
    Topology topology;
    std::vector<Vec3> positions;
};

// Residues 1 to 4 of two atoms each, all in a row: 1 Å from atom to atom, each bonded to the next.
Whole row_of_eight() {
    Whole row;
    Connectivity& c = row.connectivity;
    c.file = "row.psf";
    for (std::uint32_t i = 0; i < 8; ++i) {
        c.names.push_back({"P", "R", fmt::format("{}", 1 + i / 2), fmt::format("X{}", i)});
        c.type.push_back(fmt::format("T{}", i));
        c.charge.push_back(i);
        c.mass.push_back(12);
        c.lines.push_back(10 + i);
        row.positions.emplace_back(i, 0, 0);
        row.topology.charge.push_back(i);
        row.topology.type.push_back(i % 3);
        if (i == 0) continue;
        c.bonds.push_back({i - 1, i});
        row.topology.bonds.push_back({i - 1, i, 100.0 + i, 1});
    }
    row.topology.angles = {{2, 3, 4, 7, 1}, {1, 2, 3, 8, 1}};
    row.topology.urey_bradleys = {{2, 4, 7, 1}, {1, 3, 8, 1}};
    row.topology.dihedrals = {{5, 4, 3, 2, 1, 9, 0}, {3, 4, 5, 6, 1, 9, 0}};
    row.topology.impropers = {{2, 3, 4, 5, 9, 0}, {0, 3, 4, 5, 9, 0}};
    row.topology.cmap_terms = {{{2, 3, 4, 5}, {5, 4, 3, 2}, 1}, {{2, 3, 4, 5}, {3, 4, 5, 6}, 0}};
    row.topology.exclusions = build_exclusions(row.topology.bonds, 8);
    return row;
}

Whole read_hiv() {
    const std::filesystem::path folder = test::in_project("scenes/hiv");
    Whole hiv;
    hiv.connectivity = read_psf(folder / "system.psf");
    hiv.positions = match_positions(hiv.connectivity, read_structure(folder / "system.crd"));
    const std::array files{folder / "system.prm"};
    hiv.topology = build_topology(hiv.connectivity, read_force_field({files.begin(), files.end()}));
    return hiv;
}

std::uint32_t find_atom(const Connectivity& connectivity, const std::string& name) {
    const auto found =
        std::ranges::find(connectivity.names, name, [](const AtomName& n) { return to_string(n); });
    REQUIRE(found != connectivity.names.end());
    return static_cast<std::uint32_t>(found - connectivity.names.begin());
}

// Which atoms of the whole are in some set.
std::vector<bool> flags_of(const Atoms& atoms, std::size_t size) {
    std::vector<bool> is_in(size, false);
    for (const std::uint32_t atom : atoms) is_in[atom] = true;
    return is_in;
}

// Atoms up to three bonds away, by walking.
std::vector<bool> find_near(const std::vector<Atoms>& bonded, std::uint32_t from) {
    std::vector<bool> is_near(bonded.size(), false);
    is_near[from] = true;
    for (int bond = 0; bond < 3; ++bond) {
        const std::vector<bool> reached = is_near;
        for (std::uint32_t atom = 0; atom < bonded.size(); ++atom) {
            if (!reached[atom]) continue;
            for (const std::uint32_t other : bonded[atom]) is_near[other] = true;
        }
    }
    return is_near;
}

double pair_energy(const LennardJonesTable& table, const Whole& whole, std::uint32_t a,
                   std::uint32_t b) {
    const LennardJonesPair pair = table.row(whole.topology.type[a])[whole.topology.type[b]];
    const double r = (whole.positions[a] - whole.positions[b]).norm();
    const double s6 = std::pow(pair.rmin / r, 6);
    return pair.epsilon * (s6 * s6 - 2 * s6) +
           units::charmm_coulomb_constant * whole.topology.charge[a] * whole.topology.charge[b] / r;
}

// The energy of the terms and pairs among some atoms, in the numbers of the whole.
double sum_directly(const Whole& whole, const Atoms& atoms) {
    const Topology& t = whole.topology;
    const std::vector<bool> is_in = flags_of(atoms, t.size());
    const auto within = [&](auto terms, auto... members) {
        std::erase_if(terms, [&](const auto& term) { return !(is_in[term.*members] && ...); });
        return terms;
    };
    std::vector<Vec3> forces(t.size());
    double energy = add_bond_forces(within(t.bonds, &Bond::a, &Bond::b), whole.positions, forces);
    energy += add_angle_forces(within(t.angles, &Angle::a, &Angle::b, &Angle::c), whole.positions,
                               forces);
    energy += add_urey_bradley_forces(within(t.urey_bradleys, &UreyBradley::a, &UreyBradley::c),
                                      whole.positions, forces);
    energy += add_dihedral_forces(
        within(t.dihedrals, &Dihedral::a, &Dihedral::b, &Dihedral::c, &Dihedral::d),
        whole.positions, forces);
    energy += add_improper_forces(
        within(t.impropers, &Improper::a, &Improper::b, &Improper::c, &Improper::d),
        whole.positions, forces);
    std::vector<CmapTerm> cmaps = t.cmap_terms;
    std::erase_if(cmaps, [&](const CmapTerm& term) {
        const auto is_out = [&](std::uint32_t atom) { return !is_in[atom]; };
        return std::ranges::any_of(term.phi, is_out) || std::ranges::any_of(term.psi, is_out);
    });
    energy += add_cmap_forces(cmaps, t.cmap_maps, whole.positions, forces);
    for (const auto& [a, b] : t.exclusions.pairs14) {
        if (is_in[a] && is_in[b]) energy += pair_energy(t.lennard_jones14, whole, a, b);
    }
    std::vector<Atoms> bonded(t.size());
    for (const Bond& bond : t.bonds) {
        bonded[bond.a].push_back(bond.b);
        bonded[bond.b].push_back(bond.a);
    }
    for (const std::uint32_t a : atoms) {
        const std::vector<bool> is_near = find_near(bonded, a);
        for (const std::uint32_t b : atoms) {
            if (a < b && !is_near[b]) energy += pair_energy(t.lennard_jones, whole, a, b);
        }
    }
    return energy;
}

double energy_of(const CutSystem& system) {
    std::vector<Vec3> forces(system.positions.size(), Vec3::Zero());
    return add_forces(system.topology, {}, system.positions, forces).total();
}

}  // namespace

TEST_CASE("a sphere is the nearest whole residues, as many as fit", "[charmm][sphere]") {
    const Whole row = row_of_eight();
    const auto sphere = [&](std::uint32_t centre, std::size_t most) {
        return find_sphere(row.connectivity, row.positions, centre, most);
    };

    CHECK(sphere(3, 4) == Atoms{2, 3, 4, 5});
    CHECK(sphere(3, 5) == Atoms{2, 3, 4, 5});
    CHECK(sphere(3, 6) == Atoms{0, 1, 2, 3, 4, 5});
    CHECK(sphere(4, 4) == Atoms{2, 3, 4, 5});
    CHECK(sphere(6, 4) == Atoms{4, 5, 6, 7});
    CHECK(sphere(3, 100) == Atoms{0, 1, 2, 3, 4, 5, 6, 7});
    // Less than a residue there is not.
    CHECK(sphere(3, 1) == Atoms{2, 3});
}

TEST_CASE("the residue of the centre is in a sphere even where another atom lies on the centre",
          "[charmm][sphere]") {
    Whole row = row_of_eight();
    row.positions[0] = row.positions[5];

    CHECK(find_sphere(row.connectivity, row.positions, 5, 2) == Atoms{4, 5});
    CHECK(find_sphere(row.connectivity, row.positions, 5, 4) == Atoms{0, 1, 4, 5});
}

TEST_CASE("terms within a sphere follow its atoms, others are left out", "[charmm][sphere]") {
    const Whole row = row_of_eight();

    const CutSystem cut = cut_sphere(row.connectivity, row.topology, row.positions, 3, 4);

    CHECK(cut.atoms == Atoms{2, 3, 4, 5});
    CHECK(cut.connectivity.names[0].atom == "X2");
    CHECK(cut.connectivity.bonds ==
          std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {1, 2}, {2, 3}});
    CHECK(cut.positions[3] == Vec3(5, 0, 0));
    const Topology& t = cut.topology;
    CHECK(t.charge == std::vector<double>{2, 3, 4, 5});
    CHECK(t.type == std::vector<std::uint32_t>{2, 0, 1, 2});
    REQUIRE(t.bonds.size() == 3);
    CHECK(t.bonds[2].a == 2);
    CHECK(t.bonds[2].k == 105);
    REQUIRE(t.angles.size() == 1);
    CHECK(t.angles[0].c == 2);
    REQUIRE(t.urey_bradleys.size() == 1);
    CHECK(t.urey_bradleys[0].c == 2);
    REQUIRE(t.dihedrals.size() == 1);
    CHECK(t.dihedrals[0].a == 3);
    REQUIRE(t.impropers.size() == 1);
    CHECK(t.impropers[0].d == 3);
    REQUIRE(t.cmap_terms.size() == 1);
    CHECK(t.cmap_terms[0].psi == std::array<std::uint32_t, 4>{3, 2, 1, 0});
    CHECK(t.cmap_terms[0].map == 1);
    CHECK(t.exclusions.first == Atoms{0, 3, 5, 6, 6});
    CHECK(t.exclusions.atoms == Atoms{1, 2, 3, 2, 3, 3});
    CHECK(t.exclusions.pairs14 == std::vector<std::array<std::uint32_t, 2>>{{0, 3}});
}

TEST_CASE("a sphere of HIV protease has the energy of its terms in the whole", "[charmm][sphere]") {
    const Whole hiv = read_hiv();
    const std::uint32_t centre = find_atom(hiv.connectivity, "A ASP 25 CG");
    const std::size_t most = GENERATE(100, 1000, 2000, 4000);
    INFO(most);

    const CutSystem cut = cut_sphere(hiv.connectivity, hiv.topology, hiv.positions, centre, most);

    CHECK(cut.atoms.size() <= most);
    CHECK((most > hiv.positions.size()) == (cut.atoms.size() == hiv.positions.size()));
    CHECK_THAT(energy_of(cut), WithinRel(sum_directly(hiv, cut.atoms), 1e-11));
    // The same terms as those that the parameters give to what is bonded in the cut.
    const std::vector<std::filesystem::path> files{test::in_project("scenes/hiv/system.prm")};
    CutSystem anew = cut;
    anew.topology = build_topology(cut.connectivity, read_force_field(files));
    CHECK_THAT(energy_of(anew), WithinRel(energy_of(cut), 1e-11));
}

TEST_CASE("no residue outside of a sphere is nearer than one in it", "[charmm][sphere]") {
    const Whole hiv = read_hiv();
    const std::uint32_t centre = find_atom(hiv.connectivity, "B ILE 50 CA");

    const Atoms atoms = find_sphere(hiv.connectivity, hiv.positions, centre, 700);

    const std::vector<bool> is_in = flags_of(atoms, hiv.positions.size());
    const auto id = [&](std::size_t i) {
        const AtomName& name = hiv.connectivity.names[i];
        return name.segment + " " + name.number;
    };
    std::map<std::string, double> inside, outside;  // distance of the nearest atom
    for (std::size_t i = 0; i < is_in.size(); ++i) {
        const double distance = (hiv.positions[i] - hiv.positions[centre]).norm();
        const auto at = (is_in[i] ? inside : outside).try_emplace(id(i), distance).first;
        at->second = std::min(at->second, distance);
    }
    const auto by_distance = [](const auto& a, const auto& b) { return a.second < b.second; };
    const auto farthest = std::ranges::max_element(inside, by_distance);
    const auto nearest = std::ranges::min_element(outside, by_distance);
    CHECK(farthest->second <= nearest->second);
    for (const auto& [residue, distance] : inside) CHECK_FALSE(outside.contains(residue));
    const auto next = std::ranges::count_if(hiv.connectivity.names, [&](const AtomName& name) {
        return name.segment + " " + name.number == nearest->first;
    });
    CHECK(atoms.size() <= 700);
    CHECK(atoms.size() + static_cast<std::size_t>(next) > 700);
}
