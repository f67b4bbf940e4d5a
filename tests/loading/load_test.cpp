#include "loading/load.h"
#include "core/load_error.h"
#include "simulation/components.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

using namespace palpa;
using Catch::Matchers::Contains;

namespace {

double distance(const World& world) {
    return grip_of(world, hand_at(world, 0)).pose.place_angstrom.x();
}

// What loading says of a scene whose parameter file lacks the line that begins with `without`.
std::string error_without(const std::string& without) {
    const test::TemporaryFolder temporary;
    const std::filesystem::path& folder = temporary.path();
    std::filesystem::copy(test::in_project("scenes/water"), folder);
    std::ifstream source(test::in_project("scenes/water/tip3p.str"));
    std::ofstream target(folder / "tip3p.str");
    for (std::string line; std::getline(source, line);) {
        if (!line.starts_with(without)) target << line << '\n';
    }
    target.close();
    try {
        load_world(read_scene(folder));
    } catch (const LoadError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("the water scene becomes two molecules and a hand", "[simulation][load]") {
    World world = load_world(test::water_scene());
    int molecules = 0, hands = 0;

    world.write_each<Molecule>([&](Entity, Molecule& molecule) {
        CHECK(molecule.atoms.count == 3);
        CHECK(world.resource<AtomTable>().names[molecule.reference_atom].atom == "OH2");
        ++molecules;
    });
    world.each<Hand, Grip>([&](Entity, const Hand&, const Grip& grip) {
        CHECK(world.find<Molecule>(grip.molecule)->name == "moved");
        CHECK(world.find<Molecule>(grip.measured_from)->name == "fixed");
        ++hands;
    });

    CHECK(molecules == 2);
    CHECK(hands == 1);
    CHECK(world.resource<AtomTable>().size() == 6);
    CHECK(world.resource<AtomTable>().mass[0] == 15.9994);
    CHECK(world.resource<AtomTable>().charge[0] + world.resource<AtomTable>().charge[1] +
              world.resource<AtomTable>().charge[2] ==
          Approx(0).margin(1e-15));
    CHECK(distance(world) == 7);
}

TEST_CASE("a stroke that holds starts where nothing is felt", "[simulation][load]") {
    const World world = load_world(test::water_scene({"stroke=hold"}));

    CHECK(distance(world) == Approx(2.767).margin(0.001));
    CHECK(std::abs(force_along_line(world).force) < 1e-8);
}

TEST_CASE("a start in the scene goes before any other", "[simulation][load]") {
    CHECK(distance(load_world(test::water_scene({"stroke=hold", "hand.start_angstrom=3.5"}))) ==
          3.5);
    CHECK(distance(load_world(test::water_scene({"hand.start_angstrom=9"}))) == 9);
}

TEST_CASE("parameter files that lack something are told with file and line", "[simulation][load]") {
    CHECK_THAT(error_without("OT "), Contains("tip3p.str:17: atom type 'OT' has no NONBONDED"));
    CHECK_THAT(error_without("MASS -1 OT"), Contains("unknown atom type 'OT': no MASS line"));
    CHECK_THAT(error_without("ATOM H2"), Contains("dimer.crd:8") && Contains("has no atom 'H2'"));
    CHECK_THAT(error_without("RESI"), Contains("an ATOM line outside of a residue"));
}

TEST_CASE("each mode has the laws of the paper's table", "[simulation][load]") {
    const auto laws = [](const std::string& mode) {
        return build_coupling_laws(test::water_scene({"mode=" + mode}).coupling);
    };
    const double F = 1e-9;

    CHECK(hand_force(laws("1").force, F) == Approx(1.3363).epsilon(1e-4));
    CHECK(displacement_gain(laws("1").displacement, 0) == 0.005e9);
    CHECK(hand_force(laws("2").force, F) == Approx(1.3363).epsilon(1e-4));
    CHECK(displacement_gain(laws("2").displacement, 0) == 0.25e9);
    CHECK(hand_force(laws("3").force, F) == Approx(0.64));
    CHECK(displacement_gain(laws("3").displacement, 0) == 0.005e9);
    CHECK(hand_force(laws("4").force, F) == Approx(0.64));
    CHECK(displacement_gain(laws("4").displacement, 0) == 0.25e9);
    CHECK(hand_force(laws("5").force, F) == 0);
    CHECK(displacement_gain(laws("5").displacement, 0) == 0.25e9);
}

TEST_CASE("only guarded coupling with eq. 2 calibrated depends on whether that can be",
          "[simulation][load]") {
    CouplingDescription coupling;
    coupling.force_law = ForceLawChoice::Calibrated;
    CHECK(can_build_laws(coupling));

    coupling.A_f_min = 1e7;  // low forces alone are steeper at F_0
    CHECK_FALSE(can_build_laws(coupling));
    CouplingDescription other = coupling;
    other.mode = CouplingMode::ConstantForceConstantDisplacement;
    CHECK(can_build_laws(other));
    other = coupling;
    other.force_law = ForceLawChoice::Printed;
    CHECK(can_build_laws(other));
    other = coupling;
    other.feel_pN = {20, 3000};
    CHECK(can_build_laws(other));
}
