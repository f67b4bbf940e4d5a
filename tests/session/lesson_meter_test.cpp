// What lessons ask of the world, against values by hand.
#include "session/lesson_meter.h"

#include "core/load_error.h"
#include "devices/emulated_omni.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/lockstep.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/paths.h"
#include "tests/support/water_run.h"
#include "view/hydrogen_bonds.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;

namespace {

LessonStepDescription asking(LessonQuantity quantity, std::vector<std::string> of = {}) {
    LessonStepDescription step{"step", "text", "task", quantity, 0.0, {}, 0};
    step.of = std::move(of);
    return step;
}

const std::string fixed_oxygen = "molecule fixed and name OH2";
const std::string moved_oxygen = "molecule moved and name OH2";

// From the normals of both planes: another formula than find_dihedral's.
double dihedral_by_normals(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 first = (b - a).cross(c - b).normalized(),
               second = (c - b).cross(d - c).normalized();
    const double angle = std::acos(first.dot(second)) * 180 / std::numbers::pi;
    return first.dot(d - c) < 0 ? -angle : angle;
}

}  // namespace

TEST_CASE("a lesson measures distances between selections, and bonds from one to the other",
          "[session][lesson]") {
    SceneDescription scene = test::water_scene({"start_angstrom=2.7667"});
    scene.lesson = {
        asking(LessonQuantity::Between, {fixed_oxygen, moved_oxygen}),
        asking(LessonQuantity::Between, {"molecule fixed and name H1 H2", fixed_oxygen}),
        asking(LessonQuantity::HydrogenBonds, {"molecule fixed", "molecule moved"}),
        asking(LessonQuantity::HydrogenBonds, {"molecule fixed", "molecule fixed"}),
        asking(LessonQuantity::Way),
        asking(LessonQuantity::Force)};
    const World world = load_world(scene);

    const LessonMeter meter(scene, world);

    const std::vector<double>& values = meter.measures().values;
    REQUIRE(values.size() == 6);
    CHECK(values[0] == Approx(2.7667));
    // The middle of two hydrogens: 0.9572 Å times the cosine of half of 104.52°.
    CHECK(values[1] == Approx(0.9572 * std::cos(52.26 * std::numbers::pi / 180)).epsilon(1e-4));
    CHECK(values[2] == 1);
    CHECK(values[3] == 0);
    CHECK(values[4] == 0);
    CHECK(std::isnan(values[5]));  // ticks tell
    CHECK(meter.measures().map.empty());
}

TEST_CASE("bonds between two groups are those of all that go from one to the other",
          "[session][lesson]") {
    SceneDescription scene = read_scene(test::in_project("scenes/hairpin/scene.toml"));
    const std::vector<std::string> sides{"resid 1:8 and name N O", "resid 10:17 and name N O"};
    scene.lesson = {asking(LessonQuantity::HydrogenBonds, sides),
                    asking(LessonQuantity::HydrogenBonds, {"all", "all"}),
                    asking(LessonQuantity::HydrogenBonds, {"resid 1:12", "resid 6:17"})};
    const World world = load_world(scene);
    const std::vector<AtomName>& names = world.resource<AtomTable>().names;
    const auto is_backbone = [&](std::uint32_t atom) {
        return names[atom].atom == "N" || names[atom].atom == "O";
    };
    std::size_t strands = 0, halves = 0;
    const std::vector<HydrogenBond> bonds = find_hydrogen_bonds(world, ShownBonds::All);
    for (const HydrogenBond& bond : bonds) {
        const int one = std::stoi(names[bond.donor].number),
                  other = std::stoi(names[bond.acceptor].number);
        const int low = std::min(one, other), high = std::max(one, other);
        if (is_backbone(bond.donor) && is_backbone(bond.acceptor) && low <= 8 && high >= 10)
            ++strands;
        if ((one <= 12 && other >= 6) || (one >= 6 && other <= 12)) ++halves;
    }
    REQUIRE(strands == 7);
    REQUIRE(halves > strands);

    const LessonMeter meter(scene, world);

    const std::vector<double>& values = meter.measures().values;
    CHECK(values[0] == static_cast<double>(strands));
    CHECK(values[1] == static_cast<double>(bonds.size()));
    CHECK(values[2] == static_cast<double>(halves));
}

TEST_CASE("the hand's work is what the energy has risen by, and its way how far it went",
          "[session][lesson]") {
    SceneDescription scene =
        test::water_scene({"stroke=path", "seconds=6", "path=[[0.2, 77.5], [4, 0], [5.5, -28.3]]"});
    scene.lesson = {asking(LessonQuantity::Work), asking(LessonQuantity::Way)};
    World world = load_world(scene);
    const double start = grabbed_distance(world);
    const double energy = contact_at(world, 0).model.potential_kcal_per_mol;
    EmulatedOmni device(test::build_played_omni(scene, world));
    LessonMeter meter(scene, world);

    run_lockstep(
        {6000, 1}, build_servo_settings(scene, world, 0), device, contact_at(world, 0).model,
        [&](const HandPose& hand, const ContactModel& felt) {
            (void)step_world(world, hand, felt);
            meter.measure(world);
            return contact_at(world, 0);
        },
        [](const ServoTick&) {});

    const double risen = contact_at(world, 0).model.potential_kcal_per_mol - energy;
    REQUIRE(risen < -4);  // into the bond
    CHECK(meter.measures().values[0] == Approx(risen).margin(0.01));
    CHECK(meter.measures().values[1] ==
          Approx(std::abs(grabbed_distance(world) - start)).margin(1e-9));
}

TEST_CASE("dihedrals have their sign, and colour one cell of the map", "[session][lesson]") {
    SceneDescription scene = read_scene(test::in_project("scenes/dipeptide/scene.toml"));
    const std::vector<std::string> backbone{"name CY", "name N", "name CA", "name C", "name NT"};
    scene.lesson = {
        asking(LessonQuantity::Dihedral, {backbone[0], backbone[1], backbone[2], backbone[3]}),
        asking(LessonQuantity::Dihedral, {backbone[1], backbone[2], backbone[3], backbone[4]}),
        asking(LessonQuantity::MapCells, backbone)};
    const World world = load_world(scene);

    const LessonMeter meter(scene, world);

    const LessonMeasures& measures = meter.measures();
    const std::vector<Vec3>& p = world.resource<AtomTable>().positions;
    // Places in the file: CY 4, N 6, CA 8, C 14, NT 16.
    CHECK(measures.values[0] == Approx(dihedral_by_normals(p[4], p[6], p[8], p[14])));
    CHECK(measures.values[1] == Approx(dihedral_by_normals(p[6], p[8], p[14], p[16])));
    CHECK(measures.values[0] == Approx(-158.4).margin(1));
    CHECK(measures.values[1] == Approx(161.0).margin(1));
    CHECK(measures.values[2] == 1);
    CHECK(measures.phi_deg == measures.values[0]);
    CHECK(measures.psi_deg == measures.values[1]);
    // φ -158° is in the second column of 20°, ψ 161° in the last row.
    REQUIRE(measures.map.size() == 324);
    CHECK(measures.map[17 * 18 + 1] == 1);
}

TEST_CASE("cells of the map are counted from -180°, and both ends are on it", "[session][lesson]") {
    CHECK(map_cell(-180, -180) == 0);
    CHECK(map_cell(-160.1, -180) == 0);
    CHECK(map_cell(-159.9, -180) == 1);
    CHECK(map_cell(0, 0) == 9 * 18 + 9);
    CHECK(map_cell(180, 180) == 323);
}

TEST_CASE("a selection of a lesson that is empty, or several atoms for one, is refused",
          "[session][lesson]") {
    SceneDescription scene = test::water_scene();
    const auto build = [&] { return LessonMeter(scene, load_world(scene)); };
    scene.lesson = {asking(LessonQuantity::Between, {fixed_oxygen, "name CA"})};
    CHECK_THROWS_WITH(build(), Catch::Contains("'lesson.step.of' selects 0 atoms by \"name CA\""));
    scene.lesson = {asking(LessonQuantity::Dihedral, {fixed_oxygen, "molecule fixed and name H1",
                                                      "molecule moved", moved_oxygen})};
    CHECK_THROWS_WITH(build(),
                      Catch::Contains("selects 3 atoms by \"molecule moved\"; expected one"));
}
