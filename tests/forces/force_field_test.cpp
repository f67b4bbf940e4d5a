// The whole force field against other programs' numbers (tests/data/README.md).
#include "forces/force_field.h"

#include "forces/bonded.h"
#include "forces/cmap.h"
#include "formats/crd.h"
#include "tests/support/check_forces.h"
#include "tests/support/paths.h"
#include "tests/support/reference_case.h"
#include "tests/support/shared_data.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;
namespace fs = std::filesystem;

namespace {

const NonbondedSettings reference_settings{.coulomb_constant = test::reference_coulomb_constant};

struct Term {
    const char* reference;  // its name in the files
    double EnergyTerms::* energy;
};
const std::array terms = std::to_array<Term>({{"bond", &EnergyTerms::bond},
                                              {"angle", &EnergyTerms::angle},
                                              {"urey", &EnergyTerms::urey_bradley},
                                              {"proper", &EnergyTerms::dihedral},
                                              {"improper", &EnergyTerms::improper},
                                              {"cmap", &EnergyTerms::cmap},
                                              {"lj14", &EnergyTerms::lj14},
                                              {"coulomb14", &EnergyTerms::coulomb14},
                                              {"lj", &EnergyTerms::lj},
                                              {"coulomb", &EnergyTerms::coulomb}});

// Largest difference on an atom, relative to the larger of its own force and the rms force.
double worst_force(const std::vector<Vec3>& forces, const std::vector<Vec3>& reference) {
    double rms = 0;
    for (const Vec3& force : reference) rms += force.squaredNorm();
    rms = std::sqrt(rms / static_cast<double>(reference.size()));
    double worst = 0;
    for (std::size_t i = 0; i < forces.size(); ++i) {
        const double scale = std::max(rms, reference[i].norm());
        if (scale > 0) worst = std::max(worst, (forces[i] - reference[i]).norm() / scale);
    }
    return worst;
}

// WorstErrors errors of a case so far: energies relative, forces as above.
using WorstErrors = std::map<std::string, double>;

void check_frame(const test::ReferenceCase& reference, const test::ReferenceFrame& frame,
                 WorstErrors& worst) {
    INFO("frame " << frame.name);
    const Topology& topology = reference.topology;
    std::vector<Vec3> forces(topology.size(), Vec3::Zero());

    const EnergyTerms energy = add_forces(topology, reference_settings, frame.positions, forces);

    for (const Term& term : terms) {
        INFO(term.reference);
        const double expected = frame.energy.at(term.reference);
        const double error = std::abs(energy.*term.energy - expected);
        // Twelve digits in the files, of sums that cancel in part.
        CHECK(error <= std::max(1e-10 * std::abs(expected), 1e-9 * test::kcal_per_kilojoule));
        double& most = worst[term.reference];
        if (expected != 0) most = std::max(most, error / std::abs(expected));
    }
    // Ten digits in the files.
    const double error = worst_force(forces, frame.forces);
    CHECK(error <= 5e-9);
    worst["force"] = std::max(worst["force"], error);
}

// Forces of single terms, which the files of small cases hold as well.
void check_forces_by_term(const test::ReferenceCase& reference, const test::ReferenceFrame& frame,
                          WorstErrors& worst) {
    const Topology& t = reference.topology;
    const auto check = [&](std::vector<const char*> names, const auto& add) {
        INFO("frame " << frame.name << ", forces of " << names.front());
        std::vector<Vec3> forces(t.size(), Vec3::Zero()), expected(t.size(), Vec3::Zero());
        add(std::span<const Vec3>(frame.positions), std::span<Vec3>(forces));
        for (const char* const name : names) {
            const auto part = frame.forces_by_term.find(name);
            if (part == frame.forces_by_term.end()) continue;  // a term that the case lacks
            for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += part->second[i];
        }
        const double error = worst_force(forces, expected);
        CHECK(error <= 5e-9);
        double& most = worst[std::string("force of ") + names.front()];
        most = std::max(most, error);
    };
    check({"bond"}, [&](auto x, auto f) { add_bond_forces(t.bonds, x, f); });
    check({"angle"}, [&](auto x, auto f) { add_angle_forces(t.angles, x, f); });
    check({"urey"}, [&](auto x, auto f) { add_urey_bradley_forces(t.urey_bradleys, x, f); });
    check({"proper"}, [&](auto x, auto f) { add_dihedral_forces(t.dihedrals, x, f); });
    check({"improper"}, [&](auto x, auto f) { add_improper_forces(t.impropers, x, f); });
    check({"cmap"}, [&](auto x, auto f) { add_cmap_forces(t.cmap_terms, t.cmap_maps, x, f); });
    check({"lj", "coulomb"},
          [&](auto x, auto f) { add_nonbonded_forces(t, reference_settings, x, f); });
    check({"lj14", "coulomb14"},
          [&](auto x, auto f) { add_nonbonded14_forces(t, reference_settings, x, f); });
}

void check_case(const fs::path& folder, const std::string& name) {
    INFO(name);
    const test::ReferenceCase reference = test::read_reference_case(folder / (name + ".ff.json"));
    // Exclusions as our own search finds them; the rigid waters have no bonds to search along.
    const Exclusions found = build_exclusions(reference.topology.bonds, reference.topology.size());
    if (!reference.topology.bonds.empty()) {
        CHECK(found.first == reference.topology.exclusions.first);
        CHECK(found.atoms == reference.topology.exclusions.atoms);
        CHECK(found.pairs14 == reference.topology.exclusions.pairs14);
    }

    WorstErrors worst;
    int frames = 0;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string file = entry.path().filename().string();
        if (!file.starts_with(name + ".") || file.ends_with(".ff.json") ||
            file.ends_with(".torsion.json"))
            continue;
        for (const test::ReferenceFrame& frame : test::read_reference_frames(entry.path())) {
            check_frame(reference, frame, worst);
            if (!frame.forces_by_term.empty()) check_forces_by_term(reference, frame, worst);
            ++frames;
        }
    }
    CHECK(frames > 0);
    std::string line = fmt::format("{} frames {}", name, frames);
    for (const auto& [term, error] : worst) {
        if (error > 0) line += fmt::format(", {} {:.1e}", term, error);
    }
    std::cout << line << '\n';
}

}  // namespace

TEST_CASE("alanine dipeptide and a tetrapeptide have OpenMM's energies and forces",
          "[forces][reference]") {
    check_case(test::test_data(""), GENERATE("ala_dipeptide", "tetra_aera_c36m"));
}

TEST_CASE("every reference case has OpenMM's energies and forces", "[forces][reference]") {
    const auto folder = test::find_shared_data("reference");
    if (!folder) return;
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(*folder)) {
        const std::string file = entry.path().filename().string();
        if (file.ends_with(".ff.json")) names.push_back(file.substr(0, file.size() - 8));
    }
    std::sort(names.begin(), names.end());
    REQUIRE(names.size() >= 10);

    for (const std::string& name : names) check_case(*folder, name);
}

TEST_CASE("crambin has the energies that CHARMM prints, with CHARMM's cutoffs",
          "[forces][reference][cutoff]") {
    const auto reference_folder = test::find_shared_data("reference");
    const auto energies = test::find_shared_data("data/energies");
    if (!reference_folder || !energies) return;
    const test::ReferenceCase reference =
        test::read_reference_case(*reference_folder / "crambin_c36m.ff.json");
    const Structure structure = read_crd(*energies / "crambin_c36m.crd");
    // The two files name the same atoms in different orders.
    std::map<std::pair<std::string, std::string>, Vec3> places;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        places[{structure.names[i].number, structure.names[i].atom}] = structure.positions[i];
    }
    std::vector<Vec3> positions;
    for (const test::ReferenceAtom& atom : reference.atoms)
        positions.push_back(places.at({std::to_string(atom.number), atom.name}));
    std::vector<Vec3> forces(positions.size(), Vec3::Zero());

    const EnergyTerms energy = add_forces(reference.topology,
                                          {.electrostatics = ElectrostaticCutoff::ForceShift,
                                           .van_der_waals = VanDerWaalsCutoff::ForceSwitch,
                                           .switch_from = 10,
                                           .cutoff = 12},
                                          positions, forces);

    // crambin_energies.csv, CHARMM c49a2: five digits after the point.
    constexpr double half_digit = 0.5e-5 * (1 + 1e-6);
    CHECK(energy.bond == Approx(115.99701).margin(half_digit).epsilon(0));
    CHECK(energy.angle == Approx(304.61564).margin(half_digit).epsilon(0));
    CHECK(energy.urey_bradley == Approx(31.05476).margin(half_digit).epsilon(0));
    CHECK(energy.dihedral == Approx(364.81754).margin(half_digit).epsilon(0));
    CHECK(energy.improper == Approx(15.91693).margin(half_digit).epsilon(0));
    CHECK(energy.cmap == Approx(20.88689).margin(half_digit).epsilon(0));
    CHECK(energy.lj + energy.lj14 == Approx(-123.41393).margin(half_digit).epsilon(0));
    CHECK(energy.coulomb + energy.coulomb14 == Approx(-464.03689).margin(half_digit).epsilon(0));
    CHECK(energy.total() == Approx(265.83795).margin(half_digit).epsilon(0));
    double square = 0;
    for (const Vec3& force : forces) square += force.squaredNorm();
    CHECK(std::sqrt(square / (3.0 * static_cast<double>(forces.size()))) ==
          Approx(17.11838).margin(half_digit).epsilon(0));
}

TEST_CASE("a peptide's forces are the derivative of its energy, however it is summed",
          "[forces][reference]") {
    const test::ReferenceCase reference =
        test::read_reference_case(test::test_data("ala_dipeptide.ff.json"));
    const test::ReferenceFrame frame =
        test::read_reference_frames(test::test_data("ala_dipeptide.frames.json")).front();
    const NonbondedSettings settings =
        GENERATE(NonbondedSettings{}, NonbondedSettings{.distance_dielectric = true},
                 NonbondedSettings{.electrostatics = ElectrostaticCutoff::ForceSwitch,
                                   .van_der_waals = VanDerWaalsCutoff::ForceSwitch,
                                   .switch_from = 4,
                                   .cutoff = 6});

    test::check_forces(
        [&](std::span<const Vec3> x, std::span<Vec3> f) {
            return add_forces(reference.topology, settings, x, f).total();
        },
        frame.positions);
}

TEST_CASE("a peptide put onto one point or one line has finite energies and forces",
          "[forces][reference]") {
    const test::ReferenceCase reference =
        test::read_reference_case(test::test_data("ala_dipeptide.ff.json"));
    std::vector<Vec3> positions(reference.topology.size(), Vec3::Zero());
    if (GENERATE(false, true)) {
        for (std::size_t i = 0; i < positions.size(); ++i) {
            positions[i].x() = 1.5 * static_cast<double>(i);
        }
    }

    test::check_balance(
        [&](std::span<const Vec3> x, std::span<Vec3> f) {
            return add_forces(reference.topology, {}, x, f).total();
        },
        positions);
}
