#include "inputs/gromacs.h"

#include "tests/inputs/small_run.h"
#include "tests/support/load_error_of.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

std::string file_of(const std::vector<TextFile>& files, const std::string& name) {
    const auto found =
        std::ranges::find(files, name, [](const TextFile& f) { return f.path.string(); });
    REQUIRE(found != files.end());
    return found->text;
}

}  // namespace

TEST_CASE("alike waters are one rigid molecule of GROMACS's", "[inputs][gromacs]") {
    const auto files = format_gromacs(in_run_order(test::mixed_waters()), {});
    const std::string top = file_of(files, "system.top");
    CHECK(top.find("[ moleculetype ]\nTIP3 3\n") == top.rfind("[ moleculetype ]"));
    CHECK_THAT(top, Contains("#else\n[ settles ]\n1 1 0.09572 0.15139"));
    CHECK_THAT(top, Contains("[ molecules ]\nTIP3 2\n"));
    // kcal/mol/Å^2 without a half: 450 is 450 * 2 * 4.184 * 100 in kJ/mol/nm^2.
    CHECK_THAT(top, Contains("    1     2 1 0.09572 376560\n"));
    CHECK_THAT(file_of(files, "energy.mdp"), Contains("define = -DFLEXIBLE\n"));
    // 332.0716 kcal Å/mol/e^2 by way of a dielectric: 138.9354576 * 10 / 4.184 / 332.0716.
    CHECK_THAT(file_of(files, "run.mdp"), Contains("epsilon-r = 0.99997624"));
}

TEST_CASE("numbers of pairs reach GROMACS as sigma and epsilon", "[inputs][gromacs]") {
    RunSystem system = test::four_in_a_row();
    system.topology.type = {0, 0, 0, 1};
    system.connectivity.type[3] = "7";  // of an old file, which names types by number
    test::finish(system, {{0.1, 2}, {0.2, 1}}, {{0, 1, {0.15, 2.6}}});
    const std::string top = file_of(format_gromacs(system, {}), "system.top");
    // 4 Å / 2^(1/6) is 0.3563594872561357 nm; 0.1 kcal/mol 0.4184 kJ/mol.
    CHECK_THAT(top, Contains("AY AY 0 0.0 0.0 A 0.356359487256 0.4184\n"));
    CHECK_THAT(top, Contains("[ nonbond_params ]\nAY T7 1 0.231633666716 0.6276\n"));
    // Of atoms three bonds apart as combined: 3 Å, (0.1 * 0.2)^(1/2) kcal/mol.
    CHECK_THAT(top, Contains("[ pairs ]\n    1     4 1 0.267269615442 0.591"));
}

TEST_CASE("a box has CHARMM36's cutoff or what it has room for", "[inputs][gromacs]") {
    RunSystem system = test::four_in_a_row();
    system.box = Vec3(26, 30, 40);
    CHECK(gromacs_cutoff(system).to == 12);
    CHECK(gromacs_cutoff(system).from == 10);
    system.box = Vec3(30, 18.63, 40);
    CHECK(gromacs_cutoff(system).to == Approx(8.3));
    CHECK(gromacs_cutoff(system).from == Approx(6.3));
    CHECK_THAT(file_of(format_gromacs(system, {}), "run.mdp"), Contains("coulombtype = pme"));
    system.box = Vec3(9, 30, 30);
    CHECK_THAT(load_error_of([&] { (void)format_gromacs(system, {}); }),
               Contains("too short for a cutoff"));
}

TEST_CASE("vacuum is a box in which no atom sees another one twice", "[inputs][gromacs]") {
    const RunSystem system = test::four_in_a_row();
    const double reach = find_reach(system.positions);
    const std::vector<Vec3> places = gromacs_positions(system);
    const std::string gro = file_of(format_gromacs(system, {}), "system.gro");
    const double edge = 10 * std::stod(gro.substr(gro.rfind('\n', gro.size() - 2) + 1));
    CHECK(reach > (places[3] - places[0]).norm() + 5);
    CHECK(edge > 2 * reach + 3);
    for (const Vec3& place : places) CHECK((place - Vec3::Constant(edge / 2)).norm() < 3);
    CHECK_THAT(gro, Contains(".000000000"));  // nine decimals
}
