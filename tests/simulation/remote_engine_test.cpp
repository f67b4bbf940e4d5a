// Which atoms a remote engine has, and the spring that holds them; runs with an engine are
// tests/tools/connect_test.py's.
#include "simulation/remote_engine.h"

#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

// Two waters and an ion.
constexpr const char* waters = R"(seven atoms
    7
    1SOL     OW    1   0.100   0.100   0.100
    1SOL    HW1    2   0.196   0.100   0.100
    1SOL    HW2    3   0.076   0.193   0.100
    2SOL     OW    4   0.500   0.100   0.100
    2SOL    HW1    5   0.596   0.100   0.100
    2SOL    HW2    6   0.476   0.193   0.100
    3NA      NA    7   0.900   0.100   0.100
   2.00000   2.00000   2.00000
)";

std::string scene_text(const std::string& engine, const std::string& atom = "1") {
    return "[engine]\n" + engine +
           "[molecules.water]\nstructure = \"w.gro\"\nsegment = \"WAT\"\n"
           "[molecules.ion]\nstructure = \"w.gro\"\nsegment = \"ION\"\n"
           "[grab]\nmolecule = \"water\"\natom = \"" +
           atom + "\"\n[hand]\nstroke = \"hold\"\n";
}

World load(const std::filesystem::path& folder, const std::string& text) {
    std::ofstream(folder / "w.gro") << waters;
    return load_world(parse_scene(text, folder / "scene.toml"));
}

}  // namespace

TEST_CASE("the force of an engine's spring is linear, then as strong as it may be",
          "[simulation][engine]") {
    const double k = 5, most = 7;
    for (const Vec3& stretch : {Vec3(0.3, -0.4, 0.1), Vec3(3, -4, 1)}) {
        const EngineSpring spring = find_engine_spring(k, stretch, most);
        CHECK(spring.force.norm() == Approx(std::min(k * stretch.norm(), most)));
        CHECK(spring.force.dot(stretch) == Approx(spring.force.norm() * stretch.norm()));
        // The hand's end moves against the stretch.
        for (int axis = 0; axis < 3; ++axis) {
            const double h = 1e-5;
            const Vec3 step = h * Vec3::Unit(axis);
            const Vec3 difference = (find_engine_spring(k, stretch - step, most).force -
                                     find_engine_spring(k, stretch + step, most).force) /
                                    (2 * h);
            CHECK((spring.stiffness.col(axis) + difference).norm() < 1e-8);
        }
    }
    CHECK(find_engine_spring(k, Vec3::Zero(), most).force == Vec3::Zero());
}

TEST_CASE("a scene of a remote engine needs no force field", "[simulation][engine]") {
    const test::TemporaryFolder folder;
    const World world = load(folder.path(), scene_text(""));

    const AtomTable& table = world.resource<AtomTable>();
    CHECK(table.element == std::vector<std::string>{"O", "H", "H", "O", "H", "H", "NA"});
    CHECK(table.mass[0] == Approx(15.999));
    CHECK(table.bonds.size() == 4);  // of water, by distance; the ion has none
    // The hand holds residue 1 where its middle is.
    const Entity hand = hand_at(world, 0);
    const EngineHold& hold = *world.find<EngineHold>(hand);
    CHECK(hold.atoms == std::vector<std::uint32_t>{0, 1, 2});
    const Vec3 middle =
        (15.999 * table.positions[0] + 1.008 * (table.positions[1] + table.positions[2])) /
        (15.999 + 2 * 1.008);
    CHECK((held_place(world, hand) - middle).norm() < 1e-12);
    CHECK_FALSE(hold.is_live);
    CHECK(contact_of(world, hand).sent.model.force_newton == Vec3::Zero());
}

TEST_CASE("a remote engine's atoms are taken by springs, and nothing else is changed",
          "[simulation][engine]") {
    const test::TemporaryFolder folder;
    World world = load(folder.path(), scene_text(""));
    const Entity hand = hand_at(world, 0);

    GrabEdit{"ion"}.apply(world, 0);
    CHECK(world.find<EngineHold>(hand)->atoms == std::vector<std::uint32_t>{6});
    GrabEdit{"water:2 OW"}.apply(world, 0);
    CHECK(world.find<EngineHold>(hand)->atoms == std::vector<std::uint32_t>{3});
    ReleaseEdit{}.apply(world, 0);
    CHECK_FALSE(world.find<EngineHold>(hand));
    EditDescription remove;
    remove.action = RemoveEdit{"ion"};
    CHECK_THAT(load_error_of([&] { (void)make_edit(world, remove); }),
               Contains("a remote engine moves the atoms of this scene"));
}

TEST_CASE("an engine's atoms are found by number", "[simulation][engine]") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "sent.ndx") << "[ sent ]\n7 1 2 3\n";
    const World world = load(folder.path(), scene_text("atoms = \"sent.ndx\"\n", "#4"));

    const EngineAtoms& atoms = *find_solver<RemoteEngine>(world)->atoms;
    CHECK(atoms.in_table == std::vector<std::int32_t>{6, 0, 1, 2});
    CHECK(atoms.in_engine == std::vector<std::int32_t>{1, 2, 3, -1, -1, -1, 0});
    CHECK(world.find<EngineHold>(hand_at(world, 0))->atoms == std::vector<std::uint32_t>{3});
    std::ofstream(folder.path() / "sent.ndx") << "[ sent ]\n8\n";
    CHECK_THAT(load_error_of([&] { load(folder.path(), scene_text("atoms = \"sent.ndx\"\n")); }),
               Contains("atom 8 that the scene does not have"));
}

TEST_CASE("a table [engine] that is wrong is refused", "[simulation][engine]") {
    const test::TemporaryFolder folder;
    const auto error = [&](const std::string& engine) {
        return load_error_of([&] { load(folder.path(), scene_text(engine)); });
    };
    CHECK_THAT(error("address = \"nowhere\"\n"), Contains("expected HOST:PORT"));
    CHECK_THAT(error("address = \"127.0.0.1:70000\"\n"), Contains("expected HOST:PORT"));
    CHECK_THAT(error("program = \"lammps\"\nrate = 1\n"), Contains("LAMMPS accepts forces only"));
    CHECK_THAT(error("atoms = \"w.gro.txt\"\n"), Contains("w.gro.txt"));
}
