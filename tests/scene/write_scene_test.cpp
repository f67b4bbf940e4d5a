#include "scene/write_scene.h"

#include "core/files.h"
#include "scene/fields.h"
#include "scene/read_scene.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

using namespace palpa;

namespace fs = std::filesystem;

namespace {

const fs::path folder = test::in_project("scenes/water");

std::string formatted(const SceneDescription& scene) {
    return format_scene(
        scene, [](const fs::path& file) { return file.lexically_relative(folder).string(); });
}

SceneDescription parsed(const std::string& text) { return parse_scene(text, folder / "test.toml"); }

SceneDescription water() { return read_scene(folder); }

}  // namespace

TEST_CASE("a scene that is written reads the same", "[scene][write]") {
    const std::string text = formatted(water());

    CHECK(formatted(parsed(text)) == text);
    CHECK(parsed(text).about == water().about);
}

TEST_CASE("odd values survive being written and read, to the last bit", "[scene][write]") {
    SceneDescription scene = water();
    scene.title = "quotes \" and \\ and \t\r\n\x01\x7f, Å and 水";
    scene.about = "'''\"\"\"\n[hand]\ntitle = 1 # no comment";
    scene.force_field.files.push_back(folder / "dimer.crd");
    scene.force_field.coulomb_constant = 332.06371329919216;
    scene.molecules[0].name = "a.b \"c\"\n";
    scene.molecules[0].segment = " FIX ";
    scene.molecules[0].structural_water = true;
    scene.molecules[0].anchors = {"25 CA", "26"};
    scene.molecules[0].anchor_kcal_per_mol_angstrom2 = 0.1 + 0.2;
    scene.force_field.solvent = Solvent::Eef1Sb;
    scene.molecules[1].name = "";
    scene.molecules[1].segment = "#";
    scene.hands.front().grab = {"x", scene.molecules[0].name, "", 0.1 + 0.2};
    scene.joints.methyl = true;
    scene.joints.turn = {"A 1 \"C\" N", ""};
    scene.statics.near_angstrom = 0.1 + 12;
    scene.molecules[1].name = "x";
    scene.hands.front().grip = HandGrip::FirmGrip;
    scene.hands.front().stroke = Stroke::Path;
    scene.hands.front().start_angstrom = std::numeric_limits<double>::denorm_min();
    scene.hands.front().release_s = 1e-3;
    scene.hands.front().kick_N_s = -0.0;
    scene.hands.front().peak_nN = 0.1 + 0.2;
    scene.hands.front().path = {{-1e5, {1.0 / 3}},
                                {-0.0, {5e-324}},
                                {1e4 / 3, {-1e5, 0, 0.1}},
                                {12345.678901234567, {1e5 / 7, 0.7, 0}, {0, 1.0 / 3, 0}}};
    scene.device.servo_delay_ticks = 7;
    scene.coupling.mode = CouplingMode::NoForce;
    scene.coupling.A_f_min = 1 + std::numeric_limits<double>::epsilon();
    scene.coupling.gamma_per_N = 1e18;
    scene.coupling.feel_within_pN = 1.0 / 3;
    scene.view = {
        Representation::InHand,
        Colouring::Element,
        ShownBonds::All,
        {-0.1, 1.0 / 3, 0.7},
        "x",
        true,
        {{Representation::Surface, "chain \"A\"", Colouring::BFactor, 0.1 + 0.2},
         {Representation::Lines, "", {}, 1}},
        {"resid 25", "name 'O5\\''"},
        ShownHydrogens::Polar,
        Shadows::Soft,
        false,
        3,
        {"water", "resid 1"},
        {{"from \"above\"", {0.1 + 0.2, -90, 100}, "resid 1:3", {1.0 / 3, -0.5, 0}, {}, {}},
         {"b",
          {0, 0, 1},
          "",
          {},
          Representation::Cartoon,
          {{Representation::Lines, "water", {}, 1}, {Representation::Licorice, "ion"}}}},
        {{"all; name \"CA\""}, ShownBonds::InHand, ShownForces::Atoms, true, 1.0 / 3}};
    scene.period_ms = 10000;
    scene.seed = 1'000'000'000'000'000;
    scene.lesson = {{"zuerst", "two\nlines \"quoted\"", "do", LessonQuantity::Force, -0.25, {}, 0},
                    {"dann", "text", "task", LessonQuantity::Mode, {}, 4.0, 0.5, "b"}};

    const std::string text = formatted(scene);
    INFO(text);
    const SceneDescription back = parsed(text);

    CHECK(formatted(back) == text);
    CHECK(back.title == scene.title);
    CHECK(back.about == scene.about);
    CHECK(back.force_field.files == scene.force_field.files);
    CHECK(back.force_field.coulomb_constant == scene.force_field.coulomb_constant);
    REQUIRE(back.molecules.size() == 2);
    CHECK(back.molecules[0].name == scene.molecules[0].name);
    CHECK(back.molecules[0].segment == " FIX ");
    CHECK(back.molecules[1].motion == Motion::AlongX);
    CHECK(back.hands.front().grab.spring_kcal_per_mol_angstrom2 == 0.1 + 0.2);
    CHECK(back.joints.methyl);
    CHECK(back.joints.turn == scene.joints.turn);
    CHECK(back.statics.near_angstrom == scene.statics.near_angstrom);
    CHECK(back.force_field.solvent == Solvent::Eef1Sb);
    CHECK(back.molecules[0].structural_water);
    CHECK(back.molecules[0].anchors == scene.molecules[0].anchors);
    CHECK(back.molecules[0].anchor_kcal_per_mol_angstrom2 == 0.1 + 0.2);
    CHECK_FALSE(back.molecules[1].structural_water);
    CHECK(back.hands.front().start_angstrom == scene.hands.front().start_angstrom);
    CHECK(std::signbit(back.hands.front().kick_N_s));
    CHECK(back.hands.front().release_s == scene.hands.front().release_s);
    CHECK(back.hands.front().peak_nN == scene.hands.front().peak_nN);
    CHECK(back.hands.front().path == scene.hands.front().path);
    CHECK(back.coupling.mode == CouplingMode::NoForce);
    CHECK(back.coupling.A_f_min == scene.coupling.A_f_min);
    CHECK(back.coupling.feel_within_pN == 1.0 / 3);
    CHECK_FALSE(back.coupling.feel_pN);
    CHECK(back.view.representation == Representation::InHand);
    CHECK(back.view.colouring == Colouring::Element);
    CHECK(back.view.hydrogen_bonds == ShownBonds::All);
    CHECK(back.view.camera == scene.view.camera);
    CHECK(back.view.look_at == "x");
    CHECK(back.view.clip);
    CHECK(back.view.layers == scene.view.layers);
    CHECK(back.view.labels == scene.view.labels);
    CHECK(back.view.hydrogens == ShownHydrogens::Polar);
    CHECK(back.view.shadows == Shadows::Soft);
    CHECK_FALSE(back.view.occlusion);
    CHECK(back.view.outline == 3);
    CHECK(back.view.hidden == scene.view.hidden);
    CHECK(back.view.saved == scene.view.saved);
    CHECK(back.view.saved.at(1).layers.size() == 2);
    CHECK(back.lesson.at(1).view == "b");
    CHECK(back.view.marks == scene.view.marks);
    CHECK(back.seed == scene.seed);
    REQUIRE(back.lesson.size() == 2);
    CHECK(back.lesson[0].name == "zuerst");
    CHECK(back.lesson[0].text == scene.lesson[0].text);
    CHECK(back.lesson[0].at_least == -0.25);
    CHECK_FALSE(back.lesson[0].at_most);
    CHECK(back.lesson[1].quantity == LessonQuantity::Mode);
    CHECK(back.lesson[1].for_s == 0.5);
}

TEST_CASE("what a step of a lesson asks, shows and does is written and read again",
          "[scene][write]") {
    SceneDescription scene = water();
    scene.lesson_goal = "know";
    scene.lesson_learned = "I know.";
    scene.measured_on = "a machine";
    scene.minutes = 1.0 / 3 + 1;
    scene.level = SceneLevel::Student;
    scene.lesson = {{"one", "text", "task", LessonQuantity::HydrogenBonds, 1.0, {}, 0},
                    {"two", "text", "task", LessonQuantity::Distance, {}, {}, 0}};
    scene.lesson[0].of = {"name \"OH2\"", "molecule moved"};
    scene.lesson[0].plot = LessonPlot::Way;
    scene.lesson[0].panel = LessonPanel::Plots;
    scene.lesson[0].operator_take = "moved:1";
    scene.lesson[0].operator_coupling = {"mode=4", "A_f=1000000000"};
    scene.lesson[0].operator_path = {{1, {0.1 + 0.2, 0, 0}, {}}, {2, {0, -3, 1}, {}}};
    scene.lesson[1].question = LessonQuestion{"why?", {"so", "thus"}, 2, {"no", "yes"}};

    const SceneDescription back = parsed(formatted(scene));

    CHECK(formatted(back) == formatted(scene));
    CHECK(back.lesson_goal == "know");
    CHECK(back.lesson_learned == "I know.");
    CHECK(back.measured_on == "a machine");
    CHECK(back.minutes == scene.minutes);
    CHECK(back.level == scene.level);
    REQUIRE(back.lesson.size() == 2);
    CHECK(back.lesson[0].quantity == LessonQuantity::HydrogenBonds);
    CHECK(back.lesson[0].of == scene.lesson[0].of);
    CHECK(back.lesson[0].plot == LessonPlot::Way);
    CHECK(back.lesson[0].panel == LessonPanel::Plots);
    CHECK(back.lesson[0].operator_take == "moved:1");
    CHECK(back.lesson[0].operator_coupling.size() == 2);
    CHECK(back.lesson[0].operator_path == scene.lesson[0].operator_path);
    CHECK_FALSE(back.lesson[0].question);
    CHECK(back.lesson[1].question == scene.lesson[1].question);
}

TEST_CASE("a remote engine is written and read again, without a force field", "[scene][write]") {
    SceneDescription scene = water();
    scene.force_field.files.clear();
    scene.hands.front().stroke = Stroke::Hold;
    scene.engine = EngineDescription{.address = "10.0.0.7:3000",
                                     .program = EngineProgram::Lammps,
                                     .protocol = EngineProtocol::Two,
                                     .atoms = {},
                                     .rate = 7,
                                     .force_scale = 0.5,
                                     .most_force_nN = 2,
                                     .smoothing_ms = 20,
                                     .late_s = 3,
                                     .wait_s = 20};
    const SceneDescription read = parsed(formatted(scene));
    CHECK(read.engine == scene.engine);
    CHECK(read.force_field.files.empty());
    CHECK(parsed(formatted(water())).engine == std::nullopt);
}

TEST_CASE("every field is written, under its full key", "[scene][write]") {
    SceneDescription scene = water();
    scene.hands.front().start_angstrom = 3;
    scene.lesson = {{"STEP", "text", "task", LessonQuantity::Force, 1.0, 2.0, 0.5}};
    scene.lesson[0].operator_coupling = {"mode=4"};
    scene.lesson[0].question = LessonQuestion{"why?", {"a", "b"}, 2, {"no", "yes"}};
    scene.minutes = 7;
    scene.hands.front().release_s = 4;
    scene.joints.within_angstrom = 8;
    scene.joints.region_angstrom = 30;
    scene.statics.method = RelaxMethod::QuasiStatic;
    scene.statics.cutoff_angstrom = 12;
    scene.statics.budget_us = 1000;
    scene.coupling.feel_pN = {0.1 + 0.2, 3000};
    scene.coupling.feel_within_pN = 50;
    scene.view.representation = Representation::Licorice;
    scene.view.layers.push_back({Representation::Surface, "protein", Colouring::Potential});
    scene.view.saved = {
        {.name = "near", .representation = Representation::Lines, .layers = scene.view.layers}};
    for (MoleculeDescription& molecule : scene.molecules) {
        molecule.topology = folder / "dimer.psf";
        molecule.appearance = {Representation::Lines, Colouring::Element, false};
    }
    scene.restraints.push_back({{{"moved:1"}, std::array{1.0, 2.0, 3.0}}, {}});
    scene.pins.push_back({{{"moved:1 OH2"}}, {}});
    scene.hands.front().grab.place_angstrom = {1, 2, 3};
    scene.hands.front().grab.released = Motion::Fixed;
    scene.engine.emplace().atoms = folder / "dimer.psf";

    const std::string text = formatted(scene);

    CHECK(parsed(formatted(water())).coupling.feel_pN == water().coupling.feel_pN);
    SceneDescription ranged = water();
    ranged.coupling.feel_pN = {0.1 + 0.2, 3000};
    CHECK(parsed(formatted(ranged)).coupling.feel_pN == ranged.coupling.feel_pN);
    for (const FieldNote& field : list_fields()) {
        INFO(field.key);
        // Keys of edits and of several hands: edits_test, second_hand_test.
        if (field.key.starts_with("edits.") || field.key.starts_with("hand[")) continue;
        const std::size_t dot = field.key.rfind('.');
        const std::string last = field.key.substr(dot == std::string::npos ? 0 : dot + 1);
        CHECK(("\n" + text).find("\n" + last + " = ") != std::string::npos);
        if (dot == std::string::npos) continue;
        std::string table = field.key.substr(0, dot);
        if (table == "molecules.NAME") table = "molecules.fixed";
        if (table == "restraints" || table == "pins" || table == "view.layers" ||
            table.starts_with("view.saved"))
            table = "[" + table + "]";
        CHECK(text.find("\n[" + table + "]\n") != std::string::npos);
    }
}

TEST_CASE("files are called what the caller calls them", "[scene][write]") {
    std::set<fs::path> asked;

    const std::string text = format_scene(water(), [&](const fs::path& file) {
        asked.insert(file);
        return "../x/" + file.filename().string();
    });

    CHECK(asked == std::set{folder / "tip3p.str", folder / "dimer.crd"});
    CHECK(text.find("files = [\"../x/tip3p.str\"]\n") != std::string::npos);
    CHECK(text.find("structure = \"../x/dimer.crd\"\n") != std::string::npos);
}

TEST_CASE("the list of fields names each key once, with its default and range", "[scene][fields]") {
    std::set<std::string> keys;

    for (const FieldNote& field : list_fields()) {
        INFO(field.key);
        CHECK(keys.insert(field.key).second);
        CHECK_FALSE(field.meaning.empty());
        if (field.type.find("number") != std::string::npos) {
            CHECK_THAT(field.type, Catch::Contains(" to ") && !Catch::Contains("0 to 0"));
        }
        if (field.key == "coupling.clamp_N") {
            CHECK(field.type == "number, 0 to 3.3");
            CHECK(field.fallback == "3");
        }
        if (field.key == "molecules.NAME.motion") CHECK(field.fallback == "\"fixed\"");
        if (field.key == "grab.molecule") CHECK(field.fallback == "required");
        if (field.key == "coupling.A_f_min") CHECK(field.type == "number, 1 to 10000000000000");
    }

    CHECK(keys.count("title") == 1);
    CHECK(keys.count("molecules.NAME.segment") == 1);
    CHECK(keys.count("hand.path") == 1);
    CHECK(keys.count("run.seed") == 1);
}
