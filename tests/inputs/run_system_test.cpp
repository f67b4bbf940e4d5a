#include "inputs/run_system.h"

#include "inputs/molecules.h"
#include "tests/inputs/small_run.h"
#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

TEST_CASE("atoms of a molecule stand behind each other in a run", "[inputs]") {
    const RunSystem mixed = test::mixed_waters(), ordered = in_run_order(mixed);

    std::vector<std::string> atoms;
    for (const AtomName& name : ordered.connectivity.names)
        atoms.push_back(name.number + name.atom);
    CHECK(atoms == std::vector<std::string>{"1OH2", "1H1", "1H2", "2OH2", "2H1", "2H2"});
    CHECK(ordered.positions[4] == mixed.positions[3]);
    CHECK(ordered.topology.type == std::vector<std::uint32_t>{0, 1, 1, 0, 1, 1});
    REQUIRE(ordered.topology.angles.size() == 2);
    const Angle& angle = ordered.topology.angles[1];
    CHECK((angle.a == 4 && angle.b == 3 && angle.c == 5));
    // Pairs of a water exclude each other wherever its atoms stand.
    CHECK(ordered.topology.exclusions.of(3).size() == 2);

    const std::vector<MoleculeTerms> molecules = split_molecules(ordered.topology);
    REQUIRE(molecules.size() == 2);
    CHECK(molecules[1].atoms.first == 3);
    CHECK(molecules[1].angles[0].b == 0);
    const auto water = find_rigid_water(ordered, molecules[1]);
    REQUIRE(water);
    CHECK(water->oh == 0.9572);
    CHECK(water->hh == Approx(1.5139).margin(1e-4));  // as published
}

TEST_CASE("what no engine can run is refused", "[inputs]") {
    RunSystem system = test::four_in_a_row();
    system.topology.solvation = Solvation{};
    CHECK_THAT(load_error_of([&] { (void)in_run_order(system); }), Contains("implicit water"));
    system = test::four_in_a_row();
    system.positions[2].y() = std::numeric_limits<double>::quiet_NaN();
    CHECK_THAT(load_error_of([&] { (void)in_run_order(system); }), Contains("has no coordinates"));
    system = test::four_in_a_row();
    system.box = Vec3(10, 0, 10);
    CHECK_THAT(load_error_of([&] { (void)in_run_order(system); }), Contains("not positive"));
    CHECK_THAT(load_error_of([] { (void)in_run_order(RunSystem{}); }), Contains("no atoms"));
}

TEST_CASE("pairs of types with numbers of their own are found", "[inputs]") {
    const std::vector<LennardJonesType> types{{0.1, 2}, {0.2, 1.5}, {0.05, 1}};
    CHECK(find_uncombined(build_lennard_jones_table(types, {})).empty());
    const std::vector<Nbfix> nbfix{{2, 1, {0.15, 2.6}}};
    CHECK(find_uncombined(build_lennard_jones_table(types, nbfix)) ==
          std::vector<std::array<std::uint32_t, 2>>{{1, 2}});
}

TEST_CASE("a box that does not fit its atoms is warned of", "[inputs]") {
    RunSystem system = test::mixed_waters();
    CHECK(list_warnings(system).empty());
    system.box = Vec3(40, 40, 40);
    CHECK(list_warnings(system).size() == 3);
    system.box.reset();
    system.positions[1] = system.positions[0];
    REQUIRE(list_warnings(system).size() == 1);
    CHECK_THAT(list_warnings(system)[0], Contains("atoms overlap"));
}
