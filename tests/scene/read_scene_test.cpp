#include "scene/read_scene.h"

#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;
using test::load_error_of;

namespace fs = std::filesystem;

namespace {

// A file of this name need not exist, those that a scene names must.
const std::string file = test::in_project("scenes/water/test.toml");

// 16 lines, so that what is added stands from line 17 on.
const std::string base = R"(title = "Two waters"
[force_field]
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

)";

std::string at(int line, int column) { return fmt::format("{}:{}:{}: ", file, line, column); }

std::string replaced(std::string text, const std::string& old, const std::string& by) {
    const std::size_t place = text.find(old);
    REQUIRE(place != std::string::npos);
    return text.replace(place, old.size(), by);
}

std::string error_of(const std::string& text, const std::vector<std::string>& settings = {}) {
    return load_error_of([&] { parse_scene(text, file, settings); });
}

SceneDescription with(const std::vector<std::string>& settings) {
    return parse_scene(base, file, settings);
}

}  // namespace

TEST_CASE("a scene says what it says, and defaults for the rest", "[scene][read]") {
    const SceneDescription scene = parse_scene(base, file);

    CHECK(scene.file == file);
    CHECK(scene.title == "Two waters");
    CHECK(scene.about.empty());
    REQUIRE(scene.force_field.files.size() == 1);
    CHECK(scene.force_field.files[0] == test::in_project("scenes/water/tip3p.str"));
    CHECK(scene.force_field.coulomb_constant == 332.0716);
    REQUIRE(scene.molecules.size() == 2);
    CHECK(scene.molecules[0].name == "fixed");
    CHECK(scene.molecules[0].motion == Motion::Fixed);
    CHECK(scene.molecules[1].name == "moved");
    CHECK(scene.molecules[1].structure == test::in_project("scenes/water/dimer.crd"));
    CHECK(scene.molecules[1].segment == "MOV");
    CHECK(scene.molecules[1].reference_atom == "OH2");
    CHECK(scene.molecules[1].motion == Motion::AlongX);
    CHECK(scene.hands.front().grab.molecule == "moved");
    CHECK(scene.hands.front().grab.measured_from == "fixed");
    CHECK(scene.hands.front().grip == HandGrip::Medium);
    CHECK_FALSE(scene.hands.front().start_angstrom.has_value());
    CHECK(scene.coupling.mode == CouplingMode::Guarded);
    CHECK(scene.device.servo_delay_ticks == 1);
    CHECK(scene.period_ms == 1);
}

TEST_CASE("every kind of field is read", "[scene][read]") {
    const SceneDescription scene = parse_scene(base + R"([hand]
grip = "firm-grip"
stroke = "path"
start_angstrom = 7
path = [[0, 0.5], [1.5, -2]]
[device]
servo_delay_ticks = 7
[coupling]
mode = 4
A_d = 2.5e8
[run]
period_ms = 20
)",
                                               file);

    CHECK(grip_names[static_cast<std::size_t>(scene.hands.front().grip)] == "firm-grip");
    CHECK(scene.hands.front().stroke == Stroke::Path);
    CHECK(scene.hands.front().start_angstrom == 7.0);
    REQUIRE(scene.hands.front().path.size() == 2);
    CHECK(scene.hands.front().path[0] == PathPoint{0, {0.5, 0, 0}});
    CHECK(scene.hands.front().path[1] == PathPoint{1.5, {-2, 0, 0}});
    CHECK(scene.device.servo_delay_ticks == 7);
    CHECK(scene.coupling.mode == CouplingMode::ConstantForceConstantDisplacement);
    CHECK(scene.coupling.A_d == 2.5e8);
    CHECK(scene.period_ms == 20);
}

TEST_CASE("molecules keep the order of the file, not of their names", "[scene][read]") {
    const SceneDescription scene =
        parse_scene(base +
                        "[molecules.\"a third, odd one\"]\nstructure = \"dimer.crd\"\n"
                        "segment = \"FIX\"\nreference_atom = \"H1\"\n",
                    file);

    REQUIRE(scene.molecules.size() == 3);
    CHECK(scene.molecules[0].name == "fixed");
    CHECK(scene.molecules[1].name == "moved");
    CHECK(scene.molecules[2].name == "a third, odd one");
}

TEST_CASE("the ends of a range are inside it", "[scene][read]") {
    CHECK(with({"coupling.clamp_N=0"}).coupling.clamp_N == 0);
    CHECK(with({"coupling.clamp_N=3.3"}).coupling.clamp_N == 3.3);
    CHECK(with({"device.servo_delay_ticks=0"}).device.servo_delay_ticks == 0);
    CHECK(with({"run.seed=1000000000000000"}).seed == 1'000'000'000'000'000);
}

TEST_CASE("an unknown key is told with its near name, or with those that are known",
          "[scene][errors]") {
    CHECK(error_of(base + "[coupling]\nmod = 2\n") ==
          at(18, 1) + "unknown key 'coupling.mod'; did you mean 'mode'?");
    CHECK(error_of(base + "[hand]\n  gripp = \"firm\"\n") ==
          at(18, 3) + "unknown key 'hand.gripp'; did you mean 'grip'?");
    CHECK_THAT(error_of(base + "[run]\nfriction_N = 1.0\n"),
               StartsWith(at(18, 1) + "unknown key 'run.friction_N'; expected one of period_ms"));
    CHECK_THAT(error_of("titl = 1\n" + base),
               StartsWith(at(1, 1) + "unknown key 'titl'; did you mean 'title'?"));
    // First comes what lacks for it, at the table.
    CHECK_THAT(error_of(replaced(base, "segment", "segmemt")),
               StartsWith(at(4, 1) + "the key 'molecules.fixed.segment' is missing") &&
                   Contains("; " + at(6, 1) + "unknown key 'molecules.fixed.segmemt'"));
    CHECK_THAT(error_of(base + "[couplings]\nmode = 2\n"),
               Contains("unknown key 'couplings'; did you mean 'coupling'?"));
}

TEST_CASE("a value of the wrong type is told with what it is and should be", "[scene][errors]") {
    struct Row {
        const char* lines;
        int line, column;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {"[coupling]\nclamp_N = \"3\"", 18, 11,
         "'coupling.clamp_N' is the text \"3\"; expected a number"},
        {"[coupling]\nclamp_N = true", 18, 11, "'coupling.clamp_N' is true; expected a number"},
        {"[coupling]\nclamp_N = [1]", 18, 11,
         "'coupling.clamp_N' is the list [1]; expected a number"},
        {"[coupling]\nclamp_N = 2020-01-01", 18, 11, "is a date or time; expected a number"},
        {"[hand]\nstart_angstrom = \"far\"", 18, 18, "expected a number"},
        {"[coupling]\nfeel_pN = [1, 2, 3]", 18, 11, "expected two numbers from 0.001 to 1000000"},
        {"[coupling]\nfeel_pN = [0, 2]", 18, 11, "expected two numbers from 0.001"},
        {"[coupling]\nfeel_pN = [nan, 2]", 18, 11, "is the list [nan, 2]; expected two numbers"},
        {"[coupling]\nfeel_pN = 20", 18, 11, "expected two numbers from 0.001"},
        {"[coupling]\nfeel_within_pN = 0", 18, 18, "'coupling.feel_within_pN' is 0"},
        {"[hand]\nstart_offset_angstrom = [1, 2]", 18, 25, "expected three numbers from -1000"},
        {"[hand]\nstart_offset_angstrom = [1, 2, 3e3]", 18, 25, "expected three numbers"},
        {"[hand]\nstart_offset_angstrom = 3", 18, 25, "expected three numbers"},
        {"[hand]\ncycles = 1.0", 18, 10,
         "'hand.cycles' is 1.0; expected a whole number from 1 to 10000"},
        {"[hand]\ncycles = \"1\"", 18, 10, "expected a whole number"},
        {"[hand]\ngrip = 2", 18, 8, "'hand.grip' is 2; expected one of none, light"},
        {"[hand]\ngrip = \"frim\"", 18, 8, "expected one of none, light, slack, medium, firm"},
        {"[hand]\ngrip = \"fir\"", 18, 8, "did you mean 'firm'?"},
        {"[coupling]\nmode = 6", 18, 8, "'coupling.mode' is 6; expected one of 1, 2, 3, 4, 5"},
        {"[coupling]\nmode = 2.0", 18, 8, "expected one of 1, 2, 3, 4, 5"},
        {"[hand]\npath = 3", 18, 8, "expected a list of points"},
        {"[hand]\npath = [[0, 1], 3]", 18, 17,
         "an entry of 'hand.path' is not a point of a path; expected [s, mm], [s, mm, mm, mm] or"},
        {"[hand]\npath = [[0, 1], [3]]", 18, 17, "is not a point of a path"},
        {"[hand]\npath = [[0, 1, 2]]", 18, 9, "is not a point of a path"},
        {"[hand]\npath = [[0, \"1\"]]", 18, 9, "is not a point of a path"},
        {"[hand]\npath = [[0, true]]", 18, 9, "is not a point of a path"},
        {"[hand]\nstroke = \"lead\"", 18, 10, "is \"lead\", but 'hand.path' has no point"},
        {"[hand]\nstroke = \"lead\"\npath = [[0, 1]]\ngrip = \"none\"", 18, 10,
         "nobody moves the handle"},
        {"[hand]\nstroke = \"lead\"\npath = [[0, 0, 0, 0, 0, 0, 9]]", 19, 8,
         "which does not turn it"},
    }));
    INFO(row.lines);

    CHECK_THAT(error_of(base + row.lines + "\n"),
               StartsWith(at(row.line, row.column)) && Contains(row.what));
}

TEST_CASE("a wrong type in the base of a scene is told as well", "[scene][errors]") {
    CHECK_THAT(error_of(replaced(base, "\"Two waters\"", "2")),
               StartsWith(at(1, 9) + "'title' is 2; expected text in quotes"));
    CHECK_THAT(
        error_of(replaced(base, "[\"tip3p.str\"]", "\"tip3p.str\"")),
        StartsWith(at(3, 9) + "'force_field.files' is the text \"tip3p.str\"; expected a list"));
    CHECK_THAT(error_of(replaced(base, "[\"tip3p.str\"]", "[]")), StartsWith(at(3, 9)));
    CHECK_THAT(error_of(replaced(base, "[\"tip3p.str\"]", "[\"tip3p.str\", 3]")),
               StartsWith(at(3, 23) + "'force_field.files' is 3; expected a file name in quotes"));
    CHECK_THAT(error_of(replaced(base, "\"dimer.crd\"", "5")),
               StartsWith(at(5, 13) + "'molecules.fixed.structure' is 5; expected a file name"));
    CHECK_THAT(error_of("hand = 3\n" + base),
               StartsWith(at(1, 8) + "'hand' is 3; expected a table, [hand]"));
    CHECK_THAT(error_of("molecules = 3\n[force_field]\nfiles = [\"tip3p.str\"]\n" +
                        base.substr(base.find("[grab]"))),
               StartsWith(at(1, 13) + "'molecules' is 3; expected a table"));
    CHECK_THAT(error_of(replaced(base, "[grab]", "[molecules]\nthird = 1\n[grab]")),
               StartsWith(at(14, 9) + "'molecules.third' is 1; expected a table"));
}

TEST_CASE("a number out of its range or not finite is told with the range", "[scene][errors]") {
    struct Row {
        const char* lines;
        int line, column;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {"[coupling]\nclamp_N = 3.31", 18, 11,
         "'coupling.clamp_N' is 3.31; expected a number from 0 to 3.3"},
        {"[coupling]\nclamp_N = -0.1", 18, 11, "expected a number from 0 to 3.3"},
        {"[coupling]\n\nA_f_min = 0", 19, 11,
         "'coupling.A_f_min' is 0; expected a number from 1 to 10000000000000"},
        {"[device]\nencoder_step_mm = 1e-310", 18, 19,
         "expected a number that is 0 or from 1e-06 to 1"},
        {"[lesson.a]\ntext = \"x\"\ntask = \"y\"\nat_least = 1e300\nat_most = 1", 20, 12,
         "expected a number from -1000000 to 1000000"},
        {"[hand]\npath = [[0, 1], [1, 1e300]]", 18, 17, "numbers from -100000 to 100000"},
        {"[device]\nservo_delay_ticks = 8", 18, 21, "expected a whole number from 0 to 7"},
        {"[device]\nservo_delay_ticks = -1", 18, 21, "expected a whole number from 0 to 7"},
        {"[run]\nseed = 9223372036854775807", 18, 8, "expected a whole number from 0"},
        {"[run]\nseconds = nan", 18, 11, "'run.seconds' is nan; expected a finite number"},
        {"[run]\nseconds = inf", 18, 11, "'run.seconds' is inf; expected a finite number"},
        {"[run]\nseconds = -inf", 18, 11, "expected a finite number"},
        {"[hand]\nstart_angstrom = nan", 18, 18, "expected a finite number"},
        {"[hand]\nstart_angstrom = -1", 18, 18, "expected a number from 0 to 1000"},
        {"[hand]\npath = [[0, nan]]", 18, 9, "is not a point of a path"},
        {"[hand]\npath = [[inf, 0]]", 18, 9, "is not a point of a path"},
    }));
    INFO(row.lines);

    CHECK_THAT(error_of(base + row.lines + "\n"),
               StartsWith(at(row.line, row.column)) && Contains(row.what));
}

TEST_CASE("a file that a scene names must be there", "[scene][errors]") {
    const std::string folder = test::in_project("scenes/water/");

    CHECK_THAT(error_of(replaced(base, "tip3p.str", "tip4p.str")),
               StartsWith(at(3, 10) + "'force_field.files' names a file that does not exist: " +
                          folder + "tip4p.str; expected a file in the scene's folder"));
    CHECK_THAT(error_of(replaced(base, "\"dimer.crd\"", "\"\"")), StartsWith(at(5, 13)));
    // What a command makes may not be there yet.
    const std::string made =
        replaced(base, "[force_field]", "made_by = \"tools/make_it\"\n[force_field]");
    CHECK_THAT(error_of(replaced(made, "tip3p.str", "tip4p.str")),
               Contains("tip4p.str; expected a file in the scene's folder (its key made_by says "
                        "how to make the file)") &&
                   !Contains("make_it"));
    // A folder is no file.
    CHECK_THAT(error_of(replaced(base, "dimer.crd", "../water")),
               StartsWith(at(5, 13)) && Contains("not a regular file"));
    // The system would read it as a shorter name.
    CHECK_THAT(error_of(replaced(base, "dimer.crd", "dimer.crd\\u0000")),
               StartsWith(at(5, 13)) && Contains("expected a file name in quotes"));
}

TEST_CASE("a scene names only files below its folder, wherever links lead", "[scene][errors]") {
    const test::TemporaryFolder folder;
    const fs::path scene = folder.path() / "scene", file = scene / "scene.toml";
    fs::copy(test::in_project("scenes/water"), scene);
    fs::create_directory(scene / "sub");
    fs::rename(scene / "tip3p.str", scene / "sub" / "tip3p.str");
    const fs::path outside = folder.add_file("outside.crd", "secret words\n");
    fs::create_symlink(outside, scene / "link.crd");
    fs::create_symlink(scene / "dimer.crd", scene / "inner.crd");
    fs::create_symlink(folder.path(), scene / "up");
    const std::string below = replaced(base, "tip3p.str", "sub/tip3p.str");
    const auto error_with = [&](const std::string& name) {
        const std::string text = replaced(below, "\"dimer.crd\"", "\"" + name + "\"");
        return test::load_error_of([&] { (void)parse_scene(text, file); });
    };

    for (const std::string& name :
         {std::string("../outside.crd"), outside.string(), std::string("link.crd"),
          std::string("up/outside.crd"), std::string("sub/../../outside.crd"),
          std::string("/proc/self/environ"), std::string("../not-there.crd")}) {
        CHECK(error_with(name) ==
              fmt::format("{}:5:13: 'molecules.fixed.structure' names \"{}\", which is outside of "
                          "the scene's folder; expected a file in this folder, or --allow-outside "
                          "if you trust the scene",
                          file.string(), name));
    }
    for (const char* const name : {"dimer.crd", "./dimer.crd", "inner.crd", "sub/../dimer.crd"}) {
        CHECK_NOTHROW(
            parse_scene(replaced(below, "\"dimer.crd\"", fmt::format("\"{}\"", name)), file));
    }
    // What comes with the program; and everything, where somebody says so.
    CHECK_NOTHROW(parse_scene(
        replaced(below, "sub/tip3p.str", test::in_project("scenes/water/tip3p.str")), file));
    const std::vector<std::string> allowed{std::string(allow_outside)};
    CHECK_NOTHROW(
        parse_scene(replaced(below, "\"dimer.crd\"", "\"../outside.crd\""), file, allowed));
    // The file itself cannot say so.
    CHECK_THAT(test::load_error_of(
                   [&] { (void)parse_scene("\"--allow-outside\" = true\n" + below, file); }),
               Contains("unknown key"));
}

TEST_CASE("a message quotes no more than the beginning of a long word", "[scene][errors]") {
    const std::string error =
        error_of(base + "[coupling]\nclamp_N = \"" + std::string(5000, 'x') + "\"\n");

    CHECK(error.size() < 400);
    CHECK_THAT(error, Contains("xxx\"...; expected a number"));
}

TEST_CASE("what is required and missing is told where it should be", "[scene][errors]") {
    CHECK_THAT(error_of(""), StartsWith(at(1, 1) + "an empty scene; expected [force_field]"));
    CHECK_THAT(error_of("title = \"x\"\n"),
               StartsWith(at(1, 1) + "the table [force_field] is missing: ") &&
                   Contains("; " + at(1, 1) + "the table [molecules] is missing: ") &&
                   Contains("; " + at(1, 1) + "the table [grab] is missing: "));
    CHECK_THAT(error_of("# a comment only\n"), StartsWith(at(1, 1)));
    CHECK_THAT(error_of(replaced(base, "segment = \"FIX\"\n", "")),
               StartsWith(at(4, 1) + "the key 'molecules.fixed.segment' is missing: "));
    CHECK_THAT(error_of(replaced(base, "molecule = \"moved\"\n", "")),
               StartsWith(at(13, 1) + "the key 'grab.molecule' is missing: ") &&
                   !Contains("; " + file + ":"));
    CHECK_THAT(error_of(replaced(base, "files = [\"tip3p.str\"]\n", "")),
               StartsWith(at(2, 1) + "the key 'force_field.files' is missing: "));
    CHECK_THAT(error_of(base.substr(0, base.find("[grab]"))),
               StartsWith(at(1, 1) + "the table [grab] is missing: "));
    CHECK_THAT(error_of("[force_field]\nfiles = [\"tip3p.str\"]\n[molecules]\n"),
               Contains("the table [grab] is missing"));
    CHECK_THAT(
        error_of("[force_field]\nfiles = [\"tip3p.str\"]\n[molecules]\n[grab]\nmolecule = \"a\"\n"
                 "measured_from = \"b\"\n"),
        StartsWith(at(3, 1) + "[molecules] has no table"));
}

TEST_CASE("required text may not be empty", "[scene][errors]") {
    // An empty hand moves nothing and plans no stroke.
    CHECK_THAT(error_of(replaced(base, "\"moved\"", "\"\"") + "[hand]\nstroke = \"in-out\"\n"),
               Contains("'molecules.moved.motion' is \"along-x\"") &&
                   Contains("'hand.stroke' is \"in-out\", but the hand holds nothing"));
    CHECK_THAT(error_of(replaced(base, "\"FIX\"", "\"\"")), StartsWith(at(6, 11)));
    // Distances are measured from what is in the hand then.
    CHECK(error_of(replaced(base, "\"fixed\"", "\"\"")) == "no error");
    CHECK_THAT(error_of(replaced(base, "\"OH2\"", "\"\"")), StartsWith(at(7, 18)));
    CHECK(error_of(replaced(base, "\"Two waters\"", "\"\"")) == "no error");
}

TEST_CASE("what a saved scene says of its start is checked", "[scene][errors]") {
    const std::string restraints = "[[restraints]]\natoms = [\"moved:1 OH2\"]\n";
    CHECK_THAT(error_of(base + restraints),
               Contains("'restraints[1]' has 1 end; expected two atoms, or one and "
                        "place_angstrom"));
    CHECK(error_of(base + restraints + "place_angstrom = [0, 0, 0]\n") == "no error");
    CHECK_THAT(error_of(base + "[[pins]]\natoms = []\n"),
               Contains("'pins[1].atoms' is a list of 0; expected 1 to 4 texts"));
    CHECK_THAT(error_of(base + "[[pins]]\natoms = [\"moved\"]\n"), Contains("expected an atom"));
    const auto held = [](const std::string& more) {
        return replaced(base, "measured_from = \"fixed\"\n", "measured_from = \"fixed\"\n" + more);
    };
    CHECK_THAT(error_of(held("released = \"along-x\"\n")), Contains("expected one of fixed, free"));
    CHECK_THAT(
        error_of(held("place_angstrom = [0, 0, 0]\n")),
        Contains("'grab.place_angstrom' is the end of a spring, but the hand holds 'moved' as "
                 "a whole; expected grab.atom as well"));
}

TEST_CASE("bad TOML is told with line and column", "[scene][errors]") {
    CHECK_THAT(error_of(base + "[coupling\n"), StartsWith(file + ":17:"));
    CHECK_THAT(error_of(base + "[coupling]\nmode 2\n"), StartsWith(file + ":18:"));
    CHECK_THAT(error_of(base + "[coupling]\nmode = 2\nmode = 3\n"), StartsWith(file + ":19:"));
    CHECK_THAT(error_of(base + "[run]\nseconds = 1e999\n"), StartsWith(file + ":18:"));
    CHECK_THAT(error_of("title = \"never closed"), StartsWith(file + ":1:"));
    CHECK_THAT(error_of("title = \"\xff\xfe\"\n"), StartsWith(file + ":1:"));
    CHECK_THAT(error_of(std::string(3000, '[')), StartsWith(file + ":1:"));
    CHECK_THAT(error_of("a = " + std::string(3000, '[')), StartsWith(file + ":1:"));
}

TEST_CASE("a message of the TOML reader begins in lower case like ours", "[scene][errors]") {
    CHECK_THAT(error_of(base + "[coupling]\nmode 2\n"), Contains(": error while parsing"));
}

TEST_CASE("fields that contradict each other are told at one of them", "[scene][errors]") {
    CHECK_THAT(error_of(replaced(base, "\"moved\"", "\"move\"")),
               StartsWith(at(14, 12) + "'grab.molecule' is \"move\", which is not a molecule") &&
                   Contains("did you mean 'moved'?") && !Contains("; " + file + ":"));
    CHECK_THAT(
        error_of(base + "[molecules.third]\nstructure = \"dimer.crd\"\nsegment = \"FIX\"\n"
                        "reference_atom = \"OH2\"\nmotion = \"along-x\"\n"),
        StartsWith(at(21, 10) + "'molecules.third.motion' is \"along-x\", but the hand moves only "
                                "grab.molecule; expected fixed or free"));
    CHECK_THAT(
        error_of(replaced(base, "\"fixed\"", "\"fixd\"")),
        StartsWith(at(15, 17) + "'grab.measured_from' is \"fixd\", which is not a molecule") &&
            Contains("expected one of fixed, moved; did you mean 'fixed'?"));
    CHECK_THAT(
        error_of(replaced(base, "measured_from = \"fixed\"", "measured_from = \"moved\"")),
        StartsWith(at(15, 17) + "'grab.measured_from' is \"moved\", whose motion is \"along-x\""));
    CHECK_THAT(error_of(replaced(base, "motion = \"along-x\"\n", "")),
               StartsWith(at(13, 12) + "'grab.molecule' is \"moved\", whose motion is \"fixed\""));
    CHECK_THAT(error_of(base + "[hand]\nstart_offset_angstrom = [1, 0, 0]\n"),
               Contains("expected hand.start_angstrom"));
    CHECK_THAT(error_of(replaced(base, "along-x", "translate") + "[hand]\nstart_angstrom = 3\n"),
               Contains("expected hand.start_offset_angstrom"));

    struct Row {
        const char* lines;
        int line, column;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {"[coupling]\nF_h2_N = 1.0", 18, 10,
         "'coupling.F_h2_N' is 1 N; expected more than F_h1_N, 1 N"},
        // The other of the two is a default: told at the table that should hold it.
        {"[coupling]\nF_h1_N = 3.0", 17, 1,
         "'coupling.F_h2_N' is 3 N; expected more than F_h1_N, 3 N"},
        {"[coupling]\nA_d_max = 1.0", 18, 11, "expected A_d_min, 5000000, or more"},
        {"[coupling]\nF_hi_nN = 0.03", 18, 11, "expected more than twice F_lo_pN, 20"},
        {"[coupling]\nfeel_pN = [300, 20]", 18, 11,
         "is [300, 20]; expected the weaker force first"},
        {"[coupling]\nfeel_pN = [20, 300]\nmode = 2", 18, 11, "but coupling.mode is 2"},
        {"[coupling]\nfeel_pN = [20, 300]\nclamp_N = 2.5", 19, 11, "with feel_pN forces reach 3 N"},
        {"[run]\nperiod_ms = 1.5", 18, 13, "expected a whole number of ms"},
        {"[hand]\ngrip = \"none\"", 17, 1, "nobody moves the handle"},
        {"[hand]\ngrip = \"none\"\nstroke = \"in-out\"", 19, 10, "nobody moves the handle"},
        {"[hand]\nstroke = \"path\"", 18, 10, "'hand.path' has no point"},
        {"[hand]\npath = [[1, 0], [1, 2]]", 18, 8, "'hand.path' has the time 1 s after 1 s"},
    }));
    INFO(row.lines);
    CHECK_THAT(error_of(base + row.lines + "\n"),
               StartsWith(at(row.line, row.column)) && Contains(row.what));
}

TEST_CASE("few degrees of freedom, or a time, are of the quasi-static step alone",
          "[scene][read][errors]") {
    const std::string method = base + "[statics]\nmethod = \"second-order\"\n";
    CHECK_NOTHROW(parse_scene(method + "active = 1000000\n", file));
    CHECK_NOTHROW(parse_scene(base + "[statics]\nactive = 40\n", file));
    CHECK_THAT(
        error_of(method + "active = 40\n"),
        Contains("'statics.method' is \"second-order\", which always moves all degrees of freedom; "
                 "expected quasi-static with statics.active"));
    CHECK_THAT(error_of(method + "budget_us = 900\n"),
               Contains("expected quasi-static with statics.budget_us"));
}

TEST_CASE("a scene is in vacuum unless it names a solvent", "[scene][read]") {
    const auto scene = [](const std::string& solvent) {
        return replaced(base, "[force_field]\n", "[force_field]\nsolvent = \"" + solvent + "\"\n");
    };
    CHECK(parse_scene(base, file).force_field.solvent == Solvent::None);
    CHECK(parse_scene(scene("none"), file).force_field.solvent == Solvent::None);
    CHECK(parse_scene(scene("eef1-sb"), file).force_field.solvent == Solvent::Eef1Sb);
    CHECK_FALSE(parse_scene(base, file).molecules[0].structural_water);
    CHECK_THAT(error_of(scene("water")),
               Contains("'force_field.solvent' is the text \"water\"") && Contains("eef1-sb"));

    const std::string structural = replaced(scene("eef1-sb"), "[molecules.fixed]\n",
                                            "[molecules.fixed]\nstructural_water = true\n");
    CHECK(parse_scene(structural, file).molecules[0].structural_water);
    CHECK_THAT(
        error_of(replaced(structural, "eef1-sb", "none")),
        Contains(
            "'molecules.fixed.structural_water' is true, but the scene has no implicit solvent"));
    CHECK_THAT(error_of(scene("eef1-sb") + "[statics]\ncutoff_angstrom = 12\n"),
               Contains("'statics.cutoff_angstrom' is 12, but force_field.solvent = \"eef1-sb\"") &&
                   Contains("solvent = \"none\""));
    CHECK(error_of(base + "[statics]\ncutoff_angstrom = 12\n") == "no error");
    CHECK(with({"force_field.solvent=eef1-sb"}).force_field.solvent == Solvent::Eef1Sb);
}

TEST_CASE("what looks like a contradiction and is none passes", "[scene][read]") {
    const std::string lines = GENERATE(
        "[hand]\ngrip = \"none\"\nstroke = \"hold\"", "[coupling]\nA_d_min = 1e8\nA_d_max = 1e8",
        "[hand]\npath = [[0, 1]]\nstroke = \"path\"", "[run]\nperiod_ms = 2.0",
        "[coupling]\nfeel_pN = [20, 21]\nfeel_within_pN = 5",
        "[coupling]\nmode = 1\nfeel_within_pN = 5",
        "[statics]\nmethod = \"quasi-static\"\n[coupling]\nfeel_within_pN = 5");
    INFO(lines);

    CHECK(error_of(base + lines + "\n") == "no error");
}

TEST_CASE("of several problems all are named, in the order of the file", "[scene][errors]") {
    CHECK(error_of(base + "[run]\nseconds = -1\n[coupling]\nmod = 2\n[hand]\ncycles = 0\n") ==
          at(18, 11) + "'run.seconds' is -1; expected a number from 0.001 to 100000; " + at(20, 1) +
              "unknown key 'coupling.mod'; did you mean 'mode'?; " + at(22, 10) +
              "'hand.cycles' is 0; expected a whole number from 1 to 10000");
}

TEST_CASE("settings lie over the file", "[scene][settings]") {
    const std::string text = base + "[coupling]\nmode = 1\nclamp_N = 2.0\n";
    const auto coupling = [&](const std::vector<std::string>& settings) {
        return parse_scene(text, file, settings).coupling;
    };

    CHECK(coupling({}).mode == CouplingMode::VariableForceVariableDisplacement);
    CHECK(coupling({"coupling.mode=3"}).mode == CouplingMode::ConstantForceVariableDisplacement);
    CHECK(coupling({"mode=3"}).mode == CouplingMode::ConstantForceVariableDisplacement);
    CHECK(coupling({" mode = \"3\" "}).mode == CouplingMode::ConstantForceVariableDisplacement);
    // The rest of the table stays.
    CHECK(coupling({"mode=3"}).clamp_N == 2);
    // The last one counts.
    CHECK(coupling({"mode=3", "clamp_N=1.5", "coupling.mode=4"}).mode ==
          CouplingMode::ConstantForceConstantDisplacement);
    CHECK(coupling({"mode=3", "clamp_N=1.5", "coupling.mode=4"}).clamp_N == 1.5);
}

TEST_CASE("a setting's value is TOML or a bare word", "[scene][settings]") {
    CHECK(with({"title=Two"}).title == "Two");
    CHECK(with({"title=two words, with a comma"}).title == "two words, with a comma");
    CHECK(with({"title=\"quoted # text\""}).title == "quoted # text");
    CHECK(with({"title=\"a=b\""}).title == "a=b");
    CHECK(grip_names[static_cast<std::size_t>(with({"grip=firm-grip"}).hands.front().grip)] ==
          "firm-grip");
    CHECK(with({"start_angstrom=2.5"}).hands.front().start_angstrom == 2.5);
    CHECK(with({"path=[[0, 1], [2, 3.5]]", "stroke=path"}).hands.front().path[1] ==
          PathPoint{2, {3.5, 0, 0}});
    CHECK(
        with({"path=[[0, 1, 2, 3], [2, 3, 4, 5, 6, 7, 8]]", "stroke=path"}).hands.front().path[1] ==
        PathPoint{2, {3, 4, 5}, {6, 7, 8}});
    CHECK(with({"molecules.fixed.reference_atom=H1"}).molecules[0].reference_atom == "H1");
}

TEST_CASE("settings bring their own tables where the file has none", "[scene][settings]") {
    const SceneDescription scene = with({"device.inertia_kg=0.1", "run.seconds=3"});

    CHECK(scene.device.inertia_kg == 0.1);
    CHECK(scene.seconds == 3);
    CHECK(scene.molecules[0].name == "fixed");
    CHECK(scene.molecules[1].name == "moved");
}

TEST_CASE("what is wrong with a setting is told with the setting as place", "[scene][settings]") {
    struct Row {
        const char* setting;
        const char* message;
    };
    const auto row = GENERATE(values<Row>({
        {"coupling.mod=2", "unknown key 'coupling.mod'; did you mean 'mode'?"},
        {"clampN=2", "there is no scene key 'clampN'; did you mean 'clamp_N'?"},
        {"nonsense=2", "there is no scene key 'nonsense'"},
        {"coupling.clamp_N=4", "'coupling.clamp_N' is 4; expected a number from 0 to 3.3"},
        {"clamp_N=nan", "'coupling.clamp_N' is nan; expected a finite number"},
        {"clamp_N=1e999", "'coupling.clamp_N' is the text \"1e999\"; expected a number"},
        {"clamp_N=high", "'coupling.clamp_N' is the text \"high\"; expected a number"},
        {"grip=frm", "'hand.grip' is the text \"frm\"; expected one of"},
        {"mode=[1", "the value is not valid TOML"},
        {"mode=", "the value is not valid TOML"},
        {"title=\"open", "the value is not valid TOML"},
        {"mode", "expected KEY=VALUE"},
        {"=2", "expected KEY=VALUE"},
        {" =2", "expected KEY=VALUE"},
        {"coupling.=2", "'coupling.' is not a key"},
        {"hand.grip.x=2", "'hand.grip' is a table; expected one of"},
        {"coupling.mode.=word", "'coupling.mode.' is not a key"},
        {"F_h1_N=3.5", "'coupling.F_h2_N' is 3 N; expected more than F_h1_N, 3.5 N"},
        {"structure=x", "'structure' can mean molecules.NAME.structure; expected the full key"},
        {"motion=fixed", "'motion' can mean molecules.NAME.motion; expected the full key"},
    }));
    INFO(row.setting);

    CHECK_THAT(error_of(base, {row.setting}),
               StartsWith(std::string("--set ") + row.setting + ": " + row.message));
}

TEST_CASE("a scene is a folder with its scene.toml, or a file", "[scene][read]") {
    const test::TemporaryFolder folder;
    const fs::path water = test::in_project("scenes/water");
    const std::string missing = (folder.path() / "missing").string();

    CHECK(read_scene(water).file == water / "scene.toml");
    CHECK(read_scene(water / "scene.toml").molecules.size() == 2);
    CHECK(read_scene(water, std::vector<std::string>{"title=Other"}).title == "Other");
    CHECK_THAT(load_error_of([&] { read_scene(missing); }),
               StartsWith(missing + ": no such scene"));
    CHECK_THAT(load_error_of([&] { read_scene(folder.path()); }),
               StartsWith(folder.path().string() + ": this folder has no scene.toml"));
    const fs::path broken = folder.add_file("scene.toml", "title = 1\n");
    CHECK_THAT(load_error_of([&] { read_scene(folder.path()); }),
               StartsWith(broken.string() + ":1:"));
}

TEST_CASE("files of a scene are sought beside it, wherever one stands", "[scene][read]") {
    const test::TemporaryFolder folder;
    folder.add_file("tip3p.str", "");
    folder.add_file("dimer.crd", "");
    const fs::path own = folder.add_file("own.toml", base);

    const SceneDescription scene = read_scene(own);

    CHECK(scene.force_field.files[0] == folder.path() / "tip3p.str");
    CHECK(scene.molecules[0].structure == folder.path() / "dimer.crd");
}

TEST_CASE("numbers as people type them are taken from settings", "[scene][settings]") {
    CHECK(with({"clamp_N=.5"}).coupling.clamp_N == 0.5);
    CHECK(with({"clamp_N=2."}).coupling.clamp_N == 2);
    CHECK(with({"clamp_N=+1e0"}).coupling.clamp_N == 1);
}

TEST_CASE("a setting is one line, and a table is no value", "[scene][settings]") {
    const auto error_with = [](const std::string& setting) -> std::string {
        try {
            with({setting});
        } catch (const LoadError& error) {
            return error.what();
        }
        return "no error";
    };

    CHECK(error_with("title=\"a\"\nseconds=1") ==
          "--set: a setting has characters that cannot be printed; expected one line of text");
    CHECK_THAT(error_with("hand=3"), Contains("'hand' is a table; expected one of its keys"));
    CHECK_THAT(error_with("mode=6"), !Contains("did you mean"));
    CHECK_THAT(error_with("mode=2.0"), Contains("'coupling.mode' is 2.0; expected one of"));
    CHECK_THAT(error_with("seed=1e3"), Contains("'run.seed' is 1000.0; expected a whole number"));
}

TEST_CASE("joints, rest and a spring are read, and are as documented otherwise", "[scene][read]") {
    const SceneDescription plain = parse_scene(base, file);
    CHECK_FALSE(plain.has_statics());
    CHECK(plain.molecules[1].shape == Shape::Rigid);
    CHECK((plain.joints.hydroxyl && plain.joints.thiol && plain.joints.ammonium));
    CHECK_FALSE((plain.joints.methyl || plain.joints.amide || plain.joints.amide_nh2 ||
                 plain.joints.guanidinium_nh2));
    CHECK_FALSE(plain.joints.within_angstrom.has_value());
    CHECK_FALSE(plain.statics.method);
    CHECK(method_of(plain.statics) == RelaxMethod::SecondOrder);
    CHECK(plain.statics.pairs == PairPrecision::Fast);
    CHECK_FALSE(plain.statics.cutoff_angstrom.has_value());
    CHECK(plain.hands.front().grab.atom.empty());

    const SceneDescription scene =
        parse_scene(replaced(replaced(base, "measured_from = \"fixed\"",
                                      "measured_from = \"fixed\"\natom = \"1 OH2\"\n"
                                      "spring_kcal_per_mol_angstrom2 = 3.5"),
                             "motion = \"along-x\"", "motion = \"free\"\nshape = \"flexible\"") +
                        R"([joints]
hydroxyl = false
methyl = true
turn = ["A 25 CB CG", "A 25 C 26 N"]
rigid = []
springs = ["A 3 SG 40 SG"]
within_angstrom = 8
around = "fixed"
[statics]
method = "quasi-static"
steps = 6
largest_move_angstrom = 0.3
pairs = "double"
cutoff_angstrom = 12
rest_kcal_per_mol = 0.5
relax_steps = 0
)",
                    file);

    CHECK(scene.has_statics());
    CHECK(scene.molecules[1].motion == Motion::Free);
    CHECK(scene.molecules[1].shape == Shape::Flexible);
    CHECK(scene.hands.front().grab.atom == "1 OH2");
    CHECK(scene.hands.front().grab.spring_kcal_per_mol_angstrom2 == 3.5);
    CHECK_FALSE(scene.joints.hydroxyl);
    CHECK(scene.joints.methyl);
    CHECK(scene.joints.turn == std::vector<std::string>{"A 25 CB CG", "A 25 C 26 N"});
    CHECK(scene.joints.rigid.empty());
    CHECK(scene.joints.springs == std::vector<std::string>{"A 3 SG 40 SG"});
    CHECK(scene.joints.within_angstrom == 8.0);
    CHECK(scene.joints.around == "fixed");
    CHECK(scene.statics.method == RelaxMethod::QuasiStatic);
    CHECK(scene.statics.steps == 6);
    CHECK(scene.statics.largest_move_angstrom == 0.3);
    CHECK(scene.statics.pairs == PairPrecision::Double);
    CHECK(scene.statics.cutoff_angstrom == 12.0);
    CHECK(scene.statics.rest_kcal_per_mol == 0.5);
    CHECK(scene.statics.relax_steps == 0);
}

TEST_CASE("whatever moves by itself makes a scene one of statics", "[scene][read]") {
    const auto has_statics = [](const std::string& text) {
        return parse_scene(text, file).has_statics();
    };
    const std::string in_space = replaced(base, "along-x", "translate");

    CHECK_FALSE(has_statics(in_space));
    CHECK(has_statics(replaced(in_space, "\"translate\"", "\"translate-and-turn\"")));
    CHECK(has_statics(replaced(in_space, "\"translate\"", "\"translate\"\nshape = \"flexible\"")));
    CHECK(has_statics(in_space + "[molecules.third]\nstructure = \"dimer.crd\"\nsegment = \"FIX\"\n"
                                 "reference_atom = \"OH2\"\nmotion = \"free\"\n"));
}

TEST_CASE("flags and lists of texts are told apart from other values", "[scene][errors]") {
    struct Row {
        const char* line;
        int column;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {"methyl = 1", 10, "'joints.methyl' is 1; expected true or false"},
        {"methyl = \"true\"", 10, "'joints.methyl' is the text \"true\"; expected true or false"},
        {"turn = \"A 1 C N\"", 8, "expected a list of texts"},
        {"rigid = [\"A 1 C N\", 3]", 21, "an entry of 'joints.rigid' is"},
        {"within_angstrom = -1", 19, "expected a number from 0 to 1000"},
        {"around = \"fixt\"", 10, "'joints.around' is \"fixt\", which is not a molecule"},
        {"metyl = true", 1, "did you mean 'methyl'?"},
    }));
    INFO(row.line);

    CHECK_THAT(error_of(base + "[joints]\n" + row.line + "\n"),
               StartsWith(at(18, row.column)) && Contains(row.what));
}

TEST_CASE("the view table says how a scene is seen at first, without it the program chooses",
          "[scene][read]") {
    const ViewDescription unset = parse_scene(base, file).view;
    CHECK_FALSE(unset.representation);
    CHECK(unset.colouring == Colouring::Chain);
    CHECK(unset.camera == std::array<double, 3>{0, 0, 1});
    CHECK(unset.look_at.empty());
    CHECK_FALSE(unset.clip);
    CHECK(unset.hydrogens == ShownHydrogens::All);
    CHECK(unset.shadows == Shadows::None);
    CHECK(unset.occlusion);
    CHECK(unset.outline == 1);
    CHECK(unset.marks == ViewMarks{{}, ShownBonds::None, ShownForces::Hand, false, 0});

    const ViewDescription view = parse_scene(base + R"(
[view]
representation = "space-filling"
colour = "element"
hydrogen_bonds = "all"
camera = [-40, 12.5, 2]
look_at = "moved"
clip = true
hydrogens = "polar"
shadows = "soft"
occlusion = false
outline = 0
measure = ["name OH2; name H1", "all; all; all"]
contacts = "in-hand"
forces = "residues"
ghost = true
trail_s = 2.5
)",
                                             file)
                                     .view;
    CHECK(view.marks == ViewMarks{{"name OH2; name H1", "all; all; all"},
                                  ShownBonds::InHand,
                                  ShownForces::Residues,
                                  true,
                                  2.5});
    CHECK(view.representation == Representation::SpaceFilling);
    CHECK(view.colouring == Colouring::Element);
    CHECK(view.hydrogen_bonds == ShownBonds::All);
    CHECK(view.hydrogens == ShownHydrogens::Polar);
    CHECK(view.shadows == Shadows::Soft);
    CHECK_FALSE(view.occlusion);
    CHECK(view.outline == 0);
    CHECK(view.camera == std::array<double, 3>{-40, 12.5, 2});
    CHECK(view.look_at == "moved");
    CHECK(view.clip);
    CHECK(with({"view.representation=in-hand"}).view.representation == Representation::InHand);
}

TEST_CASE("what [view] cannot mean is refused where it stands", "[scene][errors]") {
    struct Row {
        const char* line;
        int column;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {"representation = \"liquorice\"", 18, "did you mean 'licorice'?"},
        {"representation = true", 18, "expected one of ball-and-stick, space-filling"},
        {"colour = \"chan\"", 10, "did you mean 'chain'?"},
        {"camera = [0, 10]", 10, "expected three numbers from -360 to 360"},
        {"camera = [0, 91, 1]", 10,
         "'view.camera' is [0, 91, 1]; expected [azimuth, elevation, zoom]: azimuth in degrees, "
         "elevation from -90 to 90 degrees, zoom factor from 0.01 to 100"},
        {"camera = [0, 0, 0]", 10, "zoom factor from 0.01 to 100"},
        {"look_at = \"fixt\"", 11, "'view.look_at' is \"fixt\", which is not a molecule"},
        {"clip = 1", 8, "expected true or false"},
        {"measure = \"all; all\"", 11, "expected a list of texts"},
        {"contacts = \"hand\"", 12, "expected one of none, in-hand, all"},
        {"forces = \"atom\"", 10, "did you mean 'atoms'?"},
        {"trail_s = -1", 11, "expected a number from 0 to 10000"},
        {"zoom = 2", 1, "zoom"},
    }));
    INFO(row.line);

    CHECK_THAT(error_of(base + "[view]\n" + row.line + "\n"),
               StartsWith(at(18, row.column)) && Contains(row.what));
}

TEST_CASE("what saved views cannot mean is refused where it stands", "[scene][errors]") {
    const std::string view = "[[view.saved]]\nname = \"near\"\n";
    const std::string step =
        "[lesson.one]\ntext = \"t\"\ntask = \"t\"\nat_most = 1.0\nview = \"naer\"\n";

    CHECK_THAT(error_of(base + "[[view.saved]]\ncamera = [0, 0, 1]\n"), Contains("name"));
    CHECK_THAT(error_of(base + view + "camera = [0, 91, 1]\n"),
               StartsWith(at(19, 10)) && Contains("'view.saved[1].camera' is [0, 91, 1]"));
    CHECK_THAT(error_of(base + view + view), StartsWith(at(20, 8)) &&
                                                 Contains("'view.saved[2].name' is \"near\"") &&
                                                 Contains("expected a different name"));
    CHECK_THAT(error_of(base + view + step), StartsWith(at(23, 8)) &&
                                                 Contains("'lesson.one.view' is \"naer\"") &&
                                                 Contains("expected a saved view: near"));
    CHECK_THAT(error_of(base + step), Contains("[[view.saved]] has none"));
    CHECK(parse_scene(base + view + replaced(step, "naer", "near"), file).lesson.at(0).view ==
          "near");
}

TEST_CASE("what a step of a lesson cannot ask is refused where it stands", "[scene][errors]") {
    const std::string step = "[lesson.one]\ntext = \"t\"\ntask = \"t\"\n";
    const std::string question = "[lesson.one.question]\ntext = \"?\"\nanswers = [\"a\", \"b\"]\n";
    struct Row {
        std::string lines, what;
    };
    const Row row = GENERATE_COPY(values<Row>(
        {{step, "expected one or both, or a question"},
         {step + "at_most = 1.0\n" + question + "why = [\"x\", \"y\"]\n",
          "has both a question and bounds"},
         {step + question + "why = [\"x\", \"y\"]\nright = 3\n",
          "is 3; expected the number of one of the 2 answers"},
         {step + question + "why = [\"x\", \"y\", \"z\"]\n", "has 3 texts for 2 answers"},
         {step + question, "the key 'lesson.one.question.why' is missing"},
         {step + "at_most = 1.0\nof = [\"all\"]\n",
          "has 1 selections, but distance_angstrom needs 0"},
         {step + "at_most = 1.0\nquantity = \"dihedral_deg\"\nof = [\"all\"]\n",
          "has 1 selections, but dihedral_deg needs 4"},
         {step + "at_most = 1.0\noperator_path = [[2, 1], [1, 2]]\n",
          "has the time 1 s after 2 s"}}));
    INFO(row.lines);

    CHECK_THAT(error_of(base + row.lines), Contains(row.what));
}

TEST_CASE("a flag and a list can be set over a scene", "[scene][settings]") {
    CHECK(with({"joints.methyl=true"}).joints.methyl);
    CHECK(with({"joints.rigid=[\"A 1 C N\"]"}).joints.rigid == std::vector<std::string>{"A 1 C N"});
    CHECK_THAT(error_of(base, {"joints.methyl=yes"}), Contains("expected true or false"));
}

TEST_CASE("what the hand holds, and how, must go together", "[scene][errors]") {
    const std::string in_space = replaced(base, "along-x", "translate");
    const auto by_spring = [](const std::string& text) {
        return replaced(text, "measured_from = \"fixed\"",
                        "measured_from = \"fixed\"\natom = \"1\"");
    };

    // A spring pulls at what yields; without one the molecule has to follow.
    CHECK_THAT(
        error_of(by_spring(in_space)),
        StartsWith(at(14, 12) + "'grab.molecule' is \"moved\", whose motion is \"translate\"") &&
            Contains("expected a molecule that is free, or fixed and flexible"));
    CHECK_THAT(error_of(by_spring(replaced(base, "along-x", "fixed"))),
               StartsWith(at(14, 12)) && Contains("fixed and flexible"));
    CHECK_THAT(
        error_of(replaced(base, "along-x", "free")),
        StartsWith(at(14, 12)) && Contains("expected a molecule that the hand can move: along-x, "
                                           "translate, translate-and-turn or with-handle"));
    CHECK_THAT(
        error_of(replaced(in_space, "\"translate\"", "\"with-handle\"\nshape = \"flexible\"")),
        Contains("'molecules.moved.motion' is \"with-handle\" in a scene with molecules that move "
                 "by themselves"));
    CHECK(parse_scene(by_spring(replaced(base, "along-x", "free")), file).has_statics());
    CHECK(parse_scene(by_spring(replaced(base, "\"along-x\"", "\"fixed\"\nshape = \"flexible\"")),
                      file)
              .has_statics());

    // A molecule on a line has no place beside what moves by itself.
    CHECK_THAT(error_of(replaced(base, "\"along-x\"", "\"along-x\"\nshape = \"flexible\"")),
               StartsWith(at(12, 10) + "'molecules.moved.motion' is \"along-x\" in a scene with "
                                       "molecules that move by themselves") &&
                   Contains("expected translate or translate-and-turn"));
    // Distances start at something that rests.
    CHECK_THAT(error_of(replaced(in_space, "reference_atom = \"OH2\"\n",
                                 "reference_atom = \"OH2\"\nmotion = \"free\"\n")),
               Contains("'grab.measured_from' is \"fixed\", whose motion is \"free\"; expected a "
                        "fixed molecule"));
    CHECK_THAT(error_of(in_space + "[hand]\nstart_angstrom = 3\n"),
               Contains("expected hand.start_offset_angstrom"));
}

TEST_CASE("a key of thousands of dots is refused before it is followed", "[scene][errors]") {
    std::string key = "a";
    for (int i = 0; i < 40'000; ++i) key += ".a";

    CHECK_THAT(error_of(base + key + " = 1\n"),
               StartsWith(at(17, 1) + "more than 100 dots in one line"));
    CHECK_THROWS_AS(with({key + "=1"}), LoadError);
}

TEST_CASE("a scene knows where its fields stand", "[scene][read]") {
    const SceneDescription scene = with({"mode=3"});

    CHECK(scene.place_of("grab.molecule").line > 0);
    CHECK(scene.place_of("coupling.mode").file == "--set mode=3");
    CHECK(scene.place_of("run.seed").line == 0);  // a default stands nowhere
    CHECK(scene.places.contains("coupling.mode"));
    CHECK_FALSE(scene.places.contains("run.seed"));
}
