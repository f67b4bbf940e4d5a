// A run that lines of text drive: the same as the scene with the same edits, and what is refused.
#include "session/scripted_run.h"

#include "devices/emulated_omni.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/recording.h"
#include "tests/support/emulated_hand.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Json = nlohmann::json;
using Lines = std::vector<std::string>;

namespace {

struct Played {
    std::vector<std::string> answers;
    std::string trace;  // every tick's row
    Summary summary;
    bool has_refused = false;

    Json answer(std::size_t number) const { return Json::parse(answers.at(number)); }
};

Played play(const SceneDescription& scene, const Lines& lines) {
    Played played;
    World world = load_world(scene);
    EmulatedOmni device(test::build_played_omni(scene, world));
    std::size_t next = 0;
    ScriptedRun run(scene,
                    {[&]() -> std::optional<std::string> {
                         return next < lines.size() ? std::optional(lines[next++]) : std::nullopt;
                     },
                     [&](const std::string& answer) { played.answers.push_back(answer); },
                     [&](std::size_t /*hand*/, const Vec3& place_m) { device.lead_to(place_m); }});
    SceneDescription endless = scene;
    endless.seconds = 1e6;
    Device* const devices[] = {&device};
    played.summary = run_headless(
        endless, world, devices, {}, nullptr, {}, {},
        [&](std::span<const ServoTick> ticks) {
            played.trace += trace_row(ticks);
            run.add(ticks);
        },
        [&] { return run.is_over(); },
        [&](World& now, const EditFunction& edit) { run.before_step(now, edit); });
    played.has_refused = run.has_refused();
    return played;
}

// The scene's own edits, so many seconds.
std::string trace_of(const SceneDescription& scene) {
    World world = load_world(scene);
    EmulatedOmni device(test::build_played_omni(scene, world));
    std::string trace;
    run_headless(scene, world, device, {}, nullptr, {}, {},
                 [&](const ServoTick& tick) { trace += trace_row(tick); });
    return trace;
}

// The refusal of one line.
Json refusal(const std::string& line) {
    const Played played = play(test::water_scene({"period_ms=2"}), {line});
    REQUIRE(played.answers.size() == 1);
    REQUIRE(played.has_refused);
    const Json answer = played.answer(0);
    CHECK(answer.at("ok") == false);
    CHECK(answer.at("line") == 1);
    CHECK(answer.size() == 3);
    return answer;
}

std::string why(const std::string& line) { return refusal(line).at("error"); }

}  // namespace

TEST_CASE("commands give the trace of the same edits", "[session][commands]") {
    const std::string text = R"([force_field]
files = ["tip3p.str"]
[molecules.fixed]
structure = "dimer.crd"
segment = "FIX"
reference_atom = "OH2"
[molecules.moved]
structure = "dimer.crd"
segment = "MOV"
reference_atom = "OH2"
motion = "along-x"
[grab]
molecule = "moved"
measured_from = "fixed"
[hand]
grip = "medium"
stroke = "in-out"
peak_nN = 1.0
[run]
period_ms = 5.0
seconds = 3.0
)";
    const std::string file = test::in_project("scenes/water/test.toml");
    const SceneDescription without = parse_scene(text, file);
    // The planned stroke is that of the same seconds; the last tick is the one that waits for
    // lines.
    const auto edit = [](double at_s, const std::string& line) {
        return fmt::format("[[edits]]\nat_s = {}\n{}\n", at_s, line);
    };
    const SceneDescription with = parse_scene(
        text + edit(0.5, R"(add = { residue = "TIP3", name = "third", at_angstrom = [5, 3, 0] })") +
            edit(0.5, R"(coupling = { mode = "4" })") + edit(1, "undo = true") +
            edit(1.5, R"(remove = "third")") + edit(2, "let_go = true") +
            edit(2.5, "take = \"moved\""),
        file);

    Lines lines{"# a comment",
                "",
                "run = 0.5",
                R"(add = { residue = "TIP3", name = "third", at_angstrom = [5, 3, 0] } # new)",
                R"(take = "nobody")",
                R"(coupling = { mode = "4" })",
                "step 100",
                "undo",
                "read",
                "run 0.5",
                R"(hand = "first", remove = "third")",
                "step = 100",
                "let_go = true",
                "read = \"fixed\"",
                "run = 0.5",
                "take \"moved\"",
                "run = 0.495"};
    const Played played = play(without, lines);
    std::string expected = trace_of(with);
    // Its last 4 ticks are those of the step that was not made.
    for (int row = 0; row < 4; ++row)
        expected.resize(expected.rfind('\n', expected.size() - 2) + 1);

    CHECK(played.trace == expected);
    CHECK(played.trace != trace_of(without));
    CHECK(played.summary.ticks == 2996);
    REQUIRE(played.answers.size() == lines.size() - 2);
    CHECK(played.has_refused);
    for (std::size_t i = 0; i < played.answers.size(); ++i)
        CHECK(played.answer(i).at("ok") == (i != 2));
    CHECK(played.answer(2).at("line") == 5);

    SECTION("and the same lines the same answers") {
        CHECK(play(without, lines).answers == played.answers);
    }
}

TEST_CASE("a reading is what the trace has", "[session][commands]") {
    const SceneDescription scene = test::water_scene({"period_ms=2"});

    const Played played =
        play(scene, {"run 2", "pin = [\"fixed:1 OH2\", \"moved:1 OH2\"]", "step 1",
                     "read = \"moved:1 OH2\"", "let_go", "step", "read", "quit", "step 1000"});

    REQUIRE(played.answers.size() == 8);
    const Json reading = played.answer(3);
    // The last row but those of one more step.
    std::istringstream rows(played.trace);
    std::string row;
    for (int i = 0; i <= 2002; ++i) std::getline(rows, row);
    std::vector<std::string> values;
    std::istringstream columns(row);
    for (std::string value; std::getline(columns, value, ',');) values.push_back(value);
    const auto value_of = [&](const std::string& column) {
        std::istringstream all(trace_header());
        std::string name;
        for (std::size_t i = 0; std::getline(all, name, ','); ++i)
            if (name == column) return std::stod(values.at(i));
        FAIL("no column " << column);
        return 0.0;
    };
    CHECK(reading.at("time_s") == 2.002);
    CHECK(reading.at("time_s") == value_of("time_s"));
    const Json& hand = reading.at("hands").at(0);
    CHECK(reading.at("hands").size() == 1);
    CHECK(hand.at("holds") == "moved");
    CHECK(hand.at("hand_N").at(0) == value_of("device_force_x_N"));
    // The mark and the atom are where the last step left them, at the distance of that pose.
    const double distance = hand.at("distance_angstrom");
    CHECK(reading.at("marks").at(0).get<double>() == Approx(distance).margin(0.05));
    CHECK(reading.at("atoms") == 1);
    CHECK(reading.at("centre_angstrom") == reading.at("places_angstrom").at(0));
    const Json free_hand = played.answer(6).at("hands").at(0);
    CHECK(free_hand.at("holds").is_null());
    CHECK(free_hand.at("distance_angstrom").is_null());
    CHECK_FALSE(played.has_refused);
}

TEST_CASE("the emulated hand goes where a command sends it", "[session][commands]") {
    const SceneDescription scene =
        read_scene(test::in_project("scenes/water/space.toml"), std::vector<std::string>{});

    const Played played = play(scene, {"hand_mm = [10, -20, 15]", "run 2", "read",
                                       "hand_mm = [0, 0, 0]", "run 2", "read"});

    // As far as the force on the hand bends it: 3 N on some hundred N/m.
    const auto handle = [&](std::size_t number, std::size_t axis) {
        return played.answer(number).at("hands").at(0).at("handle_mm").at(axis).get<double>();
    };
    CHECK(handle(2, 0) == Approx(10).margin(6));
    CHECK(handle(2, 1) == Approx(-20).margin(6));
    CHECK(handle(2, 2) == Approx(15).margin(6));
    CHECK(handle(5, 1) == Approx(0).margin(6));
    CHECK(handle(5, 2) == Approx(0).margin(6));
}

TEST_CASE("lines that are wrong are refused and change nothing", "[session][commands]") {
    CHECK_THAT(why("jump = 3"), Contains("unknown key 'jump'") && Contains("step"));
    CHECK_THAT(why("stpe 3"), Contains("did you mean 'step'"));
    CHECK_THAT(why("take = \"nobody\""), Contains("nobody"));
    CHECK_THAT(why("take = 5"), Contains("'take' is 5; expected text"));
    CHECK_THAT(why("take = \"moved:CA\""), Contains("expected a molecule, residue or atom"));
    CHECK_THAT(why("take = moved"), Contains("value type"));
    CHECK_THAT(why("step = 0"), Contains("expected a whole number from 1 to"));
    CHECK_THAT(why("step = 1.5"), Contains("expected a whole number"));
    CHECK_THAT(why("run = -1"), Contains("expected a number from 0.001"));
    CHECK_THAT(why("run = nan"), Contains("finite"));
    CHECK_THAT(why("hand_mm = [1, 2]"), Contains("expected three numbers"));
    CHECK_THAT(why("hand_mm = [1, 2, 2000]"), Contains("from -1000 to 1000"));
    CHECK_THAT(why("hand = \"second\", let_go = true"), Contains("the scene has one hand"));
    CHECK_THAT(why("hand = \"fifth\", let_go = true"), Contains("one of first, second"));
    CHECK_THAT(why("hand = \"first\""), Contains("the line has none of the keys take"));
    CHECK_THAT(why("take = \"moved\", let_go = true"), Contains("expected one of them"));
    CHECK_THAT(why("at_s = 3, let_go = true"), Contains("unknown key 'at_s'"));
    CHECK_THAT(why("let_go = false"), Contains("expected true"));
    CHECK_THAT(why("add = { residue = \"TIP3\" }"), Contains("the key 'add.name' is missing"));
    CHECK_THAT(why("add = { structure = \"/etc/passwd\", name = \"x\", at_angstrom = [0,0,0] }"),
               Contains("outside of the scene's folder"));
    CHECK_THAT(why("mobility = { molecule = \"moved\" }"), Contains("changes nothing"));
    CHECK_THAT(why("restraint = { atoms = [\"moved:1\"] }"), Contains("has 1 end"));
    CHECK_THAT(why("coupling = { mode = \"7\" }"), Contains("coupling.mode"));
    CHECK_THAT(why("read = \"moved:7 CA\""), Contains("names no atom"));
    CHECK_THAT(why("read = \"protien\""), Contains("column 1"));
    CHECK_THAT(why("save = \"\""), Contains("save"));
    CHECK_THAT(why("save = \"picture.xyz\""), Contains(".xyz"));
    CHECK_THAT(why("let_go = true } , { let_go = true"), Contains("expected a comment"));
    CHECK_THAT(why("let_go = true }\nother = {"), Contains("more than one line"));
    CHECK_THAT(why("take = \"moved"), !Contains("commands:"));
    CHECK_THAT(why(std::string(70'000, 'x')), Contains("expected at most 65536"));
    CHECK_THAT(why("x" + std::string(200, '.')), Contains("dots"));
    CHECK_THAT(why("step = " + std::string(5'000, '[')), !Contains("commands:"));
    CHECK_THAT(why("take = \"\xff\xfe\""), !Contains("\xff"));

    // Where one of many is wrong the others stand.
    const SceneDescription scene = test::water_scene({"period_ms=2"});
    const Lines right{"run 1", "remove = \"fixed\" # not what the other is measured from",
                      "coupling = { mode = \"4\" }", "run 1"};
    const Played with_wrong =
        play(scene, {"run 1", "remove = \"fixed\"", "coupling = { mode = \"4\", cap = 3 }",
                     "step = true", "coupling = { mode = \"4\" }", "let_go = 1", "run 1"});
    CHECK(with_wrong.has_refused);
    CHECK(with_wrong.trace == play(scene, right).trace);
}

TEST_CASE("a command may have blanks, comments and no sign", "[session][commands]") {
    const SceneDescription scene = test::water_scene();
    const auto is_there = [&](const std::string& line) {
        return parse_run_command(line, scene, {"commands", 1}).has_value();
    };
    CHECK_FALSE(is_there(""));
    CHECK_FALSE(is_there("  \t\r"));
    CHECK_FALSE(is_there("  # step 3"));
    CHECK(is_there("\tstep 3\r"));

    const auto atoms_of = [&](const std::string& line) {
        return std::get<ReadCommand>(parse_run_command(line, scene, {"commands", 1})->action).atoms;
    };
    CHECK(atoms_of("read = \"a # b\" # c \"") == "a # b");
    CHECK(atoms_of("read 'a \" # b'") == "a \" # b");
    CHECK(atoms_of("read \"a \\\" # b\"") == "a \" # b");
    CHECK(atoms_of("read") == "");
}

TEST_CASE("help names every word, and save writes what is shown", "[session][commands]") {
    const test::TemporaryFolder folder;
    const std::string file = (folder.path() / "now.pdb").generic_string();

    const Played played = play(test::water_scene(), {"help", fmt::format("save = '{}'", file),
                                                     fmt::format("save = '{}'", file)});

    std::vector<std::string> keys;
    const Json words = played.answer(0).at("words");
    for (const Json& word : words) keys.push_back(word.at("key"));
    for (const std::string_view name : edit_names)
        CHECK_THAT(keys, Catch::VectorContains(std::string(name)));
    for (const char* name : {"hand", "step", "run", "hand_mm", "read", "save", "help", "quit"})
        CHECK_THAT(keys, Catch::VectorContains(std::string(name)));
    std::ifstream written(file);
    std::size_t atoms = 0;
    for (std::string line; std::getline(written, line);)
        atoms += line.starts_with("ATOM") || line.starts_with("HETATM") ? 1 : 0;
    CHECK(atoms == 6);
    CHECK(played.answer(1).at("ok") == true);
    CHECK(played.answer(2).at("ok") == false);  // nothing is overwritten
}
