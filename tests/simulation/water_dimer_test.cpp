// The dimer against a table computed by an independent program, and atom by atom against OpenMM's
// reference platform (tests/data/README.md).
#include "core/files.h"
#include "core/text.h"
#include "core/units.h"
#include "field/pair_field.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double nN = units::newton_per_kcal_per_mol_angstrom * 1e9;
constexpr double N_per_m = units::newton_per_metre_per_kcal_per_mol_angstrom2;

struct Frame {
    std::string name;
    double lj, coulomb;        // kJ/mol
    std::vector<Vec3> places;  // nm
    std::vector<Vec3> forces;  // kJ/mol/nm
};

std::vector<Frame> read_frames(const std::string& variant) {
    const std::string text =
        read_text_file(test::test_data(std::string("water_dimer_") + variant + ".csv"));
    std::vector<Frame> frames;
    for (const std::string_view line : split_lines(text)) {
        std::vector<std::string_view> cells;
        for (std::size_t at = 0; at <= line.size();) {
            const std::size_t end = std::min(line.find(',', at), line.size());
            cells.push_back(line.substr(at, end - at));
            at = end + 1;
        }
        if (cells.at(0) == "name") continue;
        std::vector<double> v;
        for (std::size_t i = 1; i < cells.size(); ++i) v.push_back(find_real(cells[i]).value());
        REQUIRE(v.size() == 2 + 36);
        Frame frame{std::string(cells[0]), v[0], v[1], {}, {}};
        for (std::size_t atom = 0; atom < 6; ++atom) {
            frame.places.emplace_back(v[2 + 3 * atom], v[3 + 3 * atom], v[4 + 3 * atom]);
            frame.forces.emplace_back(v[20 + 3 * atom], v[21 + 3 * atom], v[22 + 3 * atom]);
        }
        frames.push_back(frame);
    }
    return frames;
}

}  // namespace

TEST_CASE("every reference pose of two waters has OpenMM's energies and forces",
          "[simulation][water]") {
    const std::string variant = GENERATE("charmm", "standard");
    // The scene's parameters, the reference's Coulomb constant.
    constexpr double reference_coulomb = 138.935457644382 / 4.184 * 10;  // kcal Å/mol/e²
    const World world = load_world(test::water_scene());
    const FieldPoints water = held_points(world, hand_at(world, 0));
    std::vector<double> sqrt_epsilon(water.sqrt_epsilon.begin(), water.sqrt_epsilon.end());
    std::vector<double> half_rmin(water.half_rmin.begin(), water.half_rmin.end());
    if (variant == "standard") {  // the reference took these with six digits, as sigma and epsilon
        sqrt_epsilon = {std::sqrt(0.636386 / 4.184), 0, 0};
        half_rmin = {0.315058 * 10 * std::cbrt(std::sqrt(2)) / 2, 0, 0};
    }
    const std::vector<Frame> frames = read_frames(variant);
    REQUIRE(frames.size() == 66);

    for (const Frame& frame : frames) {
        INFO(variant << " " << frame.name);
        std::vector<Vec3> places;
        for (const Vec3& place : frame.places) places.push_back(place * 10);
        const std::span<const Vec3> all(places);
        std::vector<Vec3> forces(6, Vec3::Zero());

        const FieldSum sum = add_pair_forces({all.first(3), water.charge, sqrt_epsilon, half_rmin},
                                             {all.last(3), water.charge, sqrt_epsilon, half_rmin},
                                             {reference_coulomb}, std::span(forces).first(3),
                                             std::span(forces).last(3));

        CHECK_THAT(sum.van_der_waals * 4.184, WithinRel(frame.lj, 1e-9));
        CHECK_THAT(sum.electrostatic * 4.184, WithinRel(frame.coulomb, 1e-9));
        for (std::size_t atom = 0; atom < 6; ++atom) {
            const Vec3 force = forces[atom] * 41.84;
            CHECK((force - frame.forces[atom]).norm() <= 1e-8 * frame.forces[atom].norm());
        }
    }
}

TEST_CASE("the scene's line has the depth, rest, stiffness and attraction of the strongest bond",
          "[simulation][water]") {
    const World world = load_world(test::water_scene());

    const double r_eq = equilibrium_distance(world).value();
    const LineForce rest = force_along_line_at(world, r_eq);
    CHECK_THAT(rest.energy, WithinAbs(-6.594, 0.005));
    CHECK_THAT(r_eq, WithinAbs(2.767, 0.002));
    CHECK_THAT(rest.stiffness * N_per_m, WithinAbs(29.3, 0.2));
    CHECK_THAT(rest.force, WithinAbs(0, 1e-8));

    double strongest = 0, where = 0;
    for (double r = r_eq; r < 8; r += 0.002) {
        const double attraction = -force_along_line_at(world, r).force * nN;
        if (attraction > strongest) {
            strongest = attraction;
            where = r;
        }
    }
    CHECK_THAT(strongest, WithinAbs(0.322, 0.002));
    CHECK_THAT(where, WithinAbs(3.10, 0.01));

    CHECK_THAT(repulsion_distance(world, 3 / nN, 7).value(), WithinAbs(2.473, 0.001));
    CHECK_THAT(repulsion_distance(world, 10 / nN, 7).value(), WithinAbs(2.325, 0.001));
    CHECK_THAT(force_along_line_at(world, 6.24).force * nN, WithinAbs(-0.020, 0.0005));
}

TEST_CASE("the line's force is as steep inward as the table says", "[simulation][water]") {
    const World world = load_world(test::water_scene());
    const auto [r, F_nN] = GENERATE(table<double, double>({{2.6, 0.954},
                                                           {2.4, 5.453},
                                                           {2.2, 28.366},
                                                           {2.0, 198.598},
                                                           {1.8, 2508.019},
                                                           {1.6, 75002.016}}));

    CHECK_THAT(force_along_line_at(world, r).force * nN, WithinRel(F_nN, 1e-3));
}

TEST_CASE(
    "the force along the line is finite wherever the hand pushes, through the other water too",
    "[simulation][water]") {
    const World world = load_world(test::water_scene());

    for (double r = -3; r < 3; r += 1e-3) {
        const LineForce line = force_along_line_at(world, r);
        REQUIRE(std::isfinite(line.energy));
        REQUIRE(std::isfinite(line.force));
        REQUIRE(std::isfinite(line.stiffness));
    }
    CHECK(std::isfinite(force_along_line_at(world, 0).force));
}
