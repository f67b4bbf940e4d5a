#include "inputs/lammps.h"

#include "tests/inputs/small_run.h"
#include "tests/support/load_error_of.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

std::string lammps_file(const RunSystem& system, const std::string& name,
                        const EngineRunOptions& options = {}) {
    const auto files = format_lammps(system, options);
    const auto found =
        std::ranges::find(files, name, [](const TextFile& f) { return f.path.string(); });
    REQUIRE(found != files.end());
    return found->text;
}

}  // namespace

TEST_CASE("a pair three bonds apart counts once in LAMMPS", "[inputs][lammps]") {
    RunSystem system = test::four_in_a_row();
    // Without a dihedral, one that costs nothing stands for the pair.
    CHECK_THAT(lammps_file(system, "system.data"),
               Contains("Dihedral Coeffs\n\n1 0.0 1 0 1.0\n\nDihedrals\n\n1 1 1 2 3 4\n"));
    // Of several multiplicities the first has the pair.
    system.topology.dihedrals = {{0, 1, 2, 3, 1, 0.5, 0}, {0, 1, 2, 3, 3, 0.2, std::numbers::pi}};
    CHECK_THAT(lammps_file(system, "system.data"),
               Contains("Dihedral Coeffs\n\n1 0.5 1 0 1.0\n2 0.2 3 180 0.0\n"));
}

TEST_CASE("atoms that stick out of a box tell LAMMPS which image they are", "[inputs][lammps]") {
    RunSystem system = test::four_in_a_row();
    system.positions[0].x() = -0.5;
    system.box = Vec3(20, 20, 20);
    const std::string data = lammps_file(system, "system.data");
    CHECK_THAT(data, Contains("1 1 1 0 19.5000000000 0.0000000000 0.0000000000 -1 0 0\n"));
    CHECK_THAT(lammps_file(system, "run.in"), Contains("kspace_style pppm"));
}

TEST_CASE("bonds to hydrogens and waters are rigid in LAMMPS", "[inputs][lammps]") {
    const RunSystem waters = in_run_order(test::mixed_waters());
    CHECK_THAT(lammps_file(waters, "run.in"), Contains("shake 1e-6 100 0 b 1 a 1"));
    CHECK_THAT(lammps_file(test::four_in_a_row(), "run.in"), !Contains("shake"));
    EngineRunOptions options;
    options.sent = {0, 1, 2, 5};
    CHECK_THAT(lammps_file(waters, "run.in", options), Contains("group sent id 1:3 6:6\n"));
}

TEST_CASE("what LAMMPS lacks is refused", "[inputs][lammps]") {
    RunSystem system = test::four_in_a_row();
    system.topology.dihedrals = {{0, 1, 2, 3, 1, 0.5, 0.3}};
    CHECK_THAT(load_error_of([&] { (void)format_lammps(system, {}); }),
               Contains("expected whole degrees"));
    system = test::four_in_a_row();
    system.topology.impropers = {{0, 1, 2, 3, 10, 0.6}};
    CHECK_THAT(load_error_of([&] { (void)format_lammps(system, {}); }),
               Contains("expected 0 or 180"));
    system = test::four_in_a_row();
    CmapMap map;
    map.size = 12;
    map.points.resize(144);
    system.topology.cmap_maps = {map};
    system.topology.cmap_terms = {{{0, 1, 2, 3}, {1, 2, 3, 0}, 0}};
    CHECK_THAT(load_error_of([&] { (void)format_lammps(system, {}); }), Contains("24 x 24"));
    system.topology.cmap_terms = {{{0, 1, 2, 3}, {0, 1, 2, 3}, 0}};
    CHECK_THAT(load_error_of([&] { (void)format_lammps(system, {}); }), Contains("do not overlap"));
}
