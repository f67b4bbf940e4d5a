// [[edits]] of a scene file: read, written, refused.
#include "scene/edits.h"

#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string edited_file = test::in_project("scenes/water/test.toml");

// 15 lines, so that what is added stands from line 16 on.
const std::string edited = R"([force_field]
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

SceneDescription read(const std::string& edits) { return parse_scene(edited + edits, edited_file); }

std::string written(const SceneDescription& scene) {
    const std::filesystem::path folder = test::in_project("scenes/water");
    return format_scene(scene, [&](const std::filesystem::path& input) {
        return input.lexically_relative(folder).string();
    });
}

std::string edit_error(const std::string& edits, const std::vector<std::string>& settings = {}) {
    return test::load_error_of([&] { (void)parse_scene(edited + edits, edited_file, settings); });
}

EditAction action_of(const std::string& line) {
    const SceneDescription scene = read("[[edits]]\nat_s = 1\n" + line + "\n");
    REQUIRE(scene.edits.size() == 1);
    return scene.edits[0].action;
}

struct Form {
    std::string line;
    EditAction action;
};

std::filesystem::path in_scene(const std::string& file) {
    return std::filesystem::path(edited_file).parent_path() / file;
}

// Every action, with all of its keys and with as few as will do.
const std::vector<Form> forms{
    {R"(take = "moved")", GrabEdit{"moved"}},
    {R"(take = "moved:25")", GrabEdit{"moved:25"}},
    {R"(take = "moved:-27A CA")", GrabEdit{"moved:-27A CA"}},
    {"let_go = true", ReleaseEdit{}},
    {"put_back = true", PutBackEdit{}},
    {R"(add = { residue = "TIP3", name = "w2", at_angstrom = [1, -2.5, 0] })",
     AddEdit{"TIP3", "", "w2", {1, -2.5, 0}}},
    {R"(add = { copy_of = "moved", name = "a \"b\"", at_angstrom = [0.1, 0.2, 0.3] })",
     AddEdit{"", "moved", "a \"b\"", {0.1, 0.2, 0.3}}},
    {R"(add = { structure = "dimer.crd", name = "w2", at_angstrom = [0, 0, 9] })",
     AddEdit{"", "", "w2", {0, 0, 9}, in_scene("dimer.crd")}},
    {R"(add = { structure = "dimer.crd", topology = "three.crd", segment = "FIX", name = "w2", )"
     R"(at_angstrom = [0, 0, 9] })",
     AddEdit{"", "", "w2", {0, 0, 9}, in_scene("dimer.crd"), in_scene("three.crd"), "FIX"}},
    {R"(remove = "w2")", RemoveEdit{"w2"}},
    {R"(rename = { molecule = "w2", to = "second water" })", RenameEdit{"w2", "second water"}},
    {R"(pin = ["fixed:1 OH2"])", PinEdit{{"fixed:1 OH2"}}},
    {R"(pin = ["a:1 A", "b:2 B", "c:3 C", "d:4 D"])",
     PinEdit{{"a:1 A", "b:2 B", "c:3 C", "d:4 D"}}},
    {R"(restraint = { atoms = ["fixed:1 OH2", "moved:1"] })",
     RestraintEdit{{"fixed:1 OH2", "moved:1"}, {}, 20, 0}},
    {R"(restraint = { atoms = ["moved:1"], place_angstrom = [1, 2, 3], )"
     R"(k_kcal_per_mol_angstrom2 = 2.5, length_angstrom = 4 })",
     RestraintEdit{{"moved:1"}, {{1, 2, 3}}, 2.5, 4}},
    {R"(mobility = { molecule = "moved", motion = "free", shape = "flexible" })",
     MobilityEdit{"moved", Motion::Free, Shape::Flexible}},
    {R"(mobility = { molecule = "moved", shape = "rigid" })",
     MobilityEdit{"moved", {}, Shape::Rigid}},
    {R"(appearance = { molecule = "moved", representation = "licorice", colour = "element", )"
     R"(visible = false })",
     AppearanceEdit{"moved", Representation::Licorice, Colouring::Element, false}},
    {R"(appearance = { molecule = "moved", visible = true })",
     AppearanceEdit{"moved", {}, {}, true}},
    {"relax = true", RelaxEdit{}},
    {"coupling = { mode = 3 }", CouplingEdit{{"mode=3"}}},
    {R"(coupling = { feel_pN = [20, 300.5], force_law = "constant", clamp_N = 3, mode = "guarded" })",
     CouplingEdit{{"mode=guarded", "clamp_N=3", "feel_pN=[20, 300.5]", "force_law=constant"}}},
    {"reset = true", ResetEdit{}},
    {"undo = true", UndoEdit{}},
    {"redo = true", RedoEdit{}}};

}  // namespace

TEST_CASE("an address is a molecule, a residue or an atom", "[scene][edits]") {
    CHECK(find_address("a") == Address{"a", "", ""});
    CHECK(find_address("a third, odd one") == Address{"a third, odd one", "", ""});
    CHECK(find_address("a:25") == Address{"a", "25", ""});
    CHECK(find_address("a:27A CA") == Address{"a", "27A", "CA"});
    CHECK(find_address("a:-3 H'1") == Address{"a", "-3", "H'1"});
    CHECK(find_address("a b:25 CA") == Address{"a b", "25", "CA"});
    for (const char* const bad : {"", ":", "a:", ":25", "a: ", "a:CA", "a:25 CA CB", "a:2.5",
                                  "a:25AB", "a:-", "a:A", "a:-A", "a:+2"}) {
        INFO(bad);
        CHECK_FALSE(find_address(bad));
    }
}

TEST_CASE("every edit is read, and reads the same once written", "[scene][edits]") {
    for (const Form& form : forms) {
        INFO(form.line);
        CHECK(action_of(form.line) == form.action);

        const SceneDescription scene = read("[[edits]]\nat_s = 0.1\n" + form.line + "\n");
        const std::string text = written(scene);
        INFO(text);
        const SceneDescription back = parse_scene(text, edited_file);
        CHECK(back.edits.at(0).action == form.action);
        CHECK(back.edits.at(0).at_s == 0.1);
        CHECK(written(back) == text);
    }
}

TEST_CASE("every kind of edit has a form in a scene", "[scene][edits]") {
    std::vector<bool> has_form(std::variant_size_v<EditAction>);
    for (const Form& form : forms) {
        const std::string key = form.line.substr(0, form.line.find(' '));
        CHECK(key == edit_names.at(form.action.index()));
        has_form[form.action.index()] = true;
    }

    CHECK(has_form == std::vector<bool>(std::variant_size_v<EditAction>, true));
}

TEST_CASE("edits keep the order of the file, with hand, time and place", "[scene][edits]") {
    const SceneDescription scene = read(R"([[edits]]
at_s = 3
hand = "second"
take = "moved"
[[edits]]
at_s = 1.5
hand = "first"
let_go = true
[[edits]]
at_s = 1.5
[edits.add]
residue = "TIP3"
name = "w2"
at_angstrom = [0, 0, 0]
[run]
seconds = 4
[second.grab]
molecule = "moved"
measured_from = "fixed"
)");

    REQUIRE(scene.edits.size() == 3);
    CHECK(scene.edits[0].at_s == 3);
    CHECK(scene.edits[0].hand == 1);
    CHECK(scene.edits[0].action == EditAction{GrabEdit{"moved"}});
    CHECK(scene.edits[0].place.file == edited_file);
    CHECK(scene.edits[0].place.line == 16);
    CHECK(scene.edits[1].at_s == 1.5);
    CHECK(scene.edits[1].hand == 0);
    CHECK(scene.edits[1].place.line == 20);
    CHECK(scene.edits[2].action == EditAction{AddEdit{"TIP3", "", "w2", {}}});
    CHECK(scene.seconds == 4);

    const SceneDescription back = parse_scene(written(scene), edited_file);
    REQUIRE(back.edits.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(back.edits[i].at_s == scene.edits[i].at_s);
        CHECK(back.edits[i].hand == scene.edits[i].hand);
        CHECK(back.edits[i].action == scene.edits[i].action);
    }
}

TEST_CASE("a scene without edits is written without", "[scene][edits]") {
    CHECK(read("").edits.empty());
    CHECK_THAT(written(read("")), !Contains("edits"));
}

TEST_CASE("what an edit cannot mean is told where it stands", "[scene][edits][errors]") {
    struct Row {
        const char* lines;
        int line, column;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {"undo = true", 16, 1, "the key 'edits[1].at_s' is missing: simulated time of the edit"},
        {"at_s = -0.1\nundo = true", 17, 8,
         "'edits[1].at_s' is -0.1; expected a number from 0 to 100000"},
        {"at_s = nan\nundo = true", 17, 8, "'edits[1].at_s' is nan; expected a finite number"},
        {"at_s = inf\nundo = true", 17, 8, "expected a finite number"},
        {"at_s = \"1\"\nundo = true", 17, 8, "expected a number"},
        {"at_s = 1", 16, 1,
         "'edits[1]' has none of the keys take, let_go, put_back, add, remove, rename,"},
        {"at_s = 1\nundo = true\n\ntake = \"a\"", 20, 1,
         "'edits[1].take' and 'undo' are both given; expected one of them"},
        {"at_s = 1\ntak = \"a\"", 18, 1, "unknown key 'edits[1].tak'; did you mean 'take'?"},
        {"at_s = 1\nfly = \"a\"", 18, 1, "unknown key 'edits[1].fly'; expected one of at_s, hand"},
        {"at_s = 1\nhand = \"fifth\"\nundo = true", 18, 8,
         "expected one of first, second, third, fourth"},
        {"at_s = 1\nhand = \"second\"\nundo = true", 18, 8,
         "'edits[1].hand' is \"second\", but the scene has one hand; expected \"first\""},
        {"at_s = 1\nundo = false", 18, 8, "'edits[1].undo' is false; expected true"},
        {"at_s = 1\nredo = 1", 18, 8, "'edits[1].redo' is 1; expected true"},
        {"at_s = 1\nlet_go = \"true\"", 18, 10, "expected true"},
        {"at_s = 1\ntake = 3", 18, 8, "'edits[1].take' is 3; expected text in quotes"},
        {"at_s = 1\ntake = \"\"", 18, 8, "expected a molecule, residue or atom, \"NAME\""},
        {"at_s = 1\ntake = \"a:25 CA CB\"", 18, 8,
         "'edits[1].take' is the text \"a:25 CA CB\"; expected a molecule, residue or atom"},
        {"at_s = 1\ntake = \"a:CA\"", 18, 8, "expected a molecule, residue or atom"},
        {"at_s = 1\nremove = \"a:25\"", 18, 10, "expected the name of a molecule"},
        {"at_s = 1\nadd = \"w\"", 18, 7, "'edits[1].add' is the text \"w\"; expected a table"},
        {"at_s = 1\nadd = { name = \"w\", at_angstrom = [0, 0, 0] }", 18, 7,
         "'edits[1].add' has none of the keys residue, copy_of, structure; expected one of them"},
        {"at_s = 1\nadd = { residue = \"A\", copy_of = \"b\", name = \"w\", "
         "at_angstrom = [0, 0, 0] }",
         18, 24, "'edits[1].add.copy_of' and 'residue' are both given"},
        {"at_s = 1\nadd = { residue = \"\", name = \"w\", at_angstrom = [0, 0, 0] }", 18, 19,
         "expected text that is not empty"},
        {"at_s = 1\nadd = { copy_of = \"\", name = \"w\", at_angstrom = [0, 0, 0] }", 18, 19,
         "expected the name of a molecule"},
        {"at_s = 1\nadd = { residue = \"A\", at_angstrom = [0, 0, 0] }", 18, 7,
         "the key 'edits[1].add.name' is missing"},
        {"at_s = 1\nadd = { residue = \"A\", name = \"w:2\", at_angstrom = [0, 0, 0] }", 18, 31,
         "expected the name of a molecule"},
        {"at_s = 1\nadd = { residue = \"A\", name = \"w\" }", 18, 7,
         "the key 'edits[1].add.at_angstrom' is missing"},
        {"at_s = 1\nadd = { residue = \"A\", name = \"w\", at_angstrom = [0, 0] }", 18, 50,
         "expected three numbers from -10000 to 10000"},
        {"at_s = 1\nadd = { residue = \"A\", name = \"w\", at_angstrom = [0, 0, nan] }", 18, 50,
         "expected three numbers"},
        {"at_s = 1\nadd = { residue = \"A\", name = \"w\", at_angstrom = [0, 0, 0], x = 1 }", 18,
         61, "unknown key 'edits[1].add.x'"},
        {"at_s = 1\nadd = { structure = \"no.crd\", name = \"w\", at_angstrom = [0, 0, 0] }", 18,
         21, "'edits[1].add.structure' names a file that does not exist: "},
        {"at_s = 1\nadd = { structure = \"../../README.md\", name = \"w\", "
         "at_angstrom = [0, 0, 0] }",
         18, 21,
         "is outside of the scene's folder; expected a file in this folder, or --allow-outside"},
        {"at_s = 1\nadd = { structure = \"dimer.crd\", topology = \"/etc/passwd\", name = \"w\", "
         "at_angstrom = [0, 0, 0] }",
         18, 45, "'edits[1].add.topology' names \"/etc/passwd\", which is outside"},
        {"at_s = 1\nadd = { structure = 3, name = \"w\", at_angstrom = [0, 0, 0] }", 18, 21,
         "expected a file name in quotes"},
        {"at_s = 1\nadd = { structure = \"dimer.crd\", residue = \"A\", name = \"w\", "
         "at_angstrom = [0, 0, 0] }",
         18, 34, "'edits[1].add.residue' and 'structure' are both given"},
        {"at_s = 1\nadd = { residue = \"A\", segment = \"B\", name = \"w\", at_angstrom = [0, 0, "
         "0] }",
         18, 24, "unknown key 'edits[1].add.segment'"},
        {"at_s = 1\npin = \"a:1 A\"", 18, 7, "expected a list of texts"},
        {"at_s = 1\npin = []", 18, 7, "'edits[1].pin' is a list of 0; expected 1 to 4 texts"},
        {"at_s = 1\npin = [\"a:1 A\", \"a:1 A\", \"a:1 A\", \"a:1 A\", \"a:1 A\"]", 18, 7,
         "is a list of 5; expected 1 to 4"},
        {"at_s = 1\npin = [\"a:1 A\", \"a:1\"]", 18, 17,
         "an entry of 'edits[1].pin' is the text \"a:1\"; expected an atom, \"NAME:25 CA\""},
        {"at_s = 1\npin = [3]", 18, 8, "an entry of 'edits[1].pin' is 3; expected text"},
        {"at_s = 1\nrestraint = { atoms = [\"a\"] }", 18, 24, "expected a residue or atom"},
        {"at_s = 1\nrestraint = { atoms = [\"a:1\"] }", 18, 13,
         "'edits[1].restraint' has 1 end; expected two atoms, or one and place_angstrom"},
        {"at_s = 1\nrestraint = { atoms = [\"a:1\", \"b:1\"], place_angstrom = [0, 0, 0] }", 18, 13,
         "has 3 ends"},
        {"at_s = 1\nrestraint = { place_angstrom = [0, 0, 0] }", 18, 13,
         "the key 'edits[1].restraint.atoms' is missing"},
        {"at_s = 1\nrestraint = { atoms = [\"a:1\", \"b:1\"], k_kcal_per_mol_angstrom2 = -1 }", 18,
         66, "expected a number from 0 to 10000"},
        {"at_s = 1\nrestraint = { atoms = [\"a:1\", \"b:1\"], length_angstrom = -1 }", 18, 57,
         "expected a number from 0 to 1000"},
        {"at_s = 1\nmobility = { molecule = \"a\" }", 18, 12,
         "'edits[1].mobility' changes nothing; expected motion or shape"},
        {"at_s = 1\nmobility = { motion = \"free\" }", 18, 12,
         "the key 'edits[1].mobility.molecule' is missing"},
        {"at_s = 1\nmobility = { molecule = \"a\", motion = \"fee\" }", 18, 39,
         "did you mean 'free'?"},
        {"at_s = 1\nappearance = { molecule = \"a\" }", 18, 14,
         "changes nothing; expected representation, colour or visible"},
        {"at_s = 1\nappearance = { molecule = \"a\", visible = 1 }", 18, 42,
         "expected true or false"},
        {"at_s = 1\ncoupling = { mod = 3 }", 18, 14,
         "unknown key 'edits[1].coupling.mod'; did you mean 'mode'?"},
        {"at_s = 1\ncoupling = { clamp_N = 9 }", 18, 24,
         "'edits[1].coupling.clamp_N' is 9; expected a number from 0 to 3.3"},
        {"at_s = 1\ncoupling = {}", 18, 12, "'edits[1].coupling' is empty; expected one of mode,"},
        {"at_s = 1\ncoupling = 3", 18, 12, "'edits[1].coupling' is 3; expected a table"},
        {"at_s = 1\nundo = true\n[[edits]]\nat_s = 1\ntake = \"a:\"", 21, 8, "'edits[2].take'"},
    }));
    INFO(row.lines);

    CHECK_THAT(edit_error(std::string("[[edits]]\n") + row.lines + "\n"),
               StartsWith(fmt::format("{}:{}:{}: ", edited_file, row.line, row.column)) &&
                   Contains(row.what) && !Contains("; " + std::string(edited_file) + ":"));
}

TEST_CASE("edits cannot be set here of tables", "[scene][edits][errors]") {
    const auto error_before = [](const std::string& line) {
        return test::load_error_of([&] { (void)parse_scene(line + "\n" + edited, edited_file); });
    };

    CHECK_THAT(
        error_before("edits = 3"),
        StartsWith(edited_file + ":1:9: 'edits' is 3; expected a list of tables, [[edits]]"));
    CHECK_THAT(edit_error("[edits]\nat_s = 1\nundo = true\n"),
               Contains("'edits' is a table; expected a list of tables"));
    CHECK_THAT(error_before("edits = [{ at_s = 1, undo = true }, 5]"),
               StartsWith(edited_file + ":1:37: 'edits[2]' is 5; expected a table"));
    CHECK(parse_scene("edits = [{ at_s = 1, undo = true }]\n" + edited, edited_file).edits.size() ==
          1);
    CHECK(parse_scene("edits = []\n" + edited, edited_file).edits.empty());
}

TEST_CASE("edits are no settings, and take no name of one", "[scene][edits][settings]") {
    const std::string edit = "[[edits]]\nat_s = 1\nundo = true\n";

    CHECK_THAT(edit_error(edit, {"edits.undo=false"}),
               Contains("edits cannot be set here; write them as [[edits]] into the scene file"));
    CHECK_THAT(edit_error(edit, {"edits=[]"}), Contains("edits cannot be set here"));
    CHECK_THAT(edit_error(edit, {"undo=true"}), Contains("there is no scene key 'undo'"));
    CHECK(edit_error(edit, {"grip=firm"}) == "no error");
    const std::string outside =
        "[[edits]]\nat_s = 1\nadd = { structure = \"../../README.md\", name = \"w\", "
        "at_angstrom = [0, 0, 0] }\n";
    CHECK(edit_error(outside, {std::string(allow_outside)}) == "no error");
}

TEST_CASE("settings of a coupling are applied over it", "[scene][edits]") {
    CouplingDescription coupling;
    coupling.clamp_N = 2;
    coupling.feel_within_pN = 5;
    const auto with = [&](const std::vector<std::string>& settings) {
        return with_settings(coupling, settings);
    };

    CHECK(with({}) == coupling);
    CouplingDescription expected = coupling;
    expected.mode = CouplingMode::ConstantForceVariableDisplacement;
    CHECK(with({"mode=3"}) == expected);
    CHECK(with({" coupling.mode = \"3\""}) == expected);
    CHECK(with({"mode=4", "mode=3"}) == expected);
    expected.mode = CouplingMode::Guarded;
    expected.force_law = ForceLawChoice::Constant;
    expected.clamp_N = 3;
    expected.feel_pN = {20, 300.5};
    CHECK(with({"force_law=constant", "clamp_N=3", "feel_pN=[20, 300.5]", "mode=guarded"}) ==
          expected);
    // What an edit of a scene has are such settings.
    for (const Form& form : forms) {
        if (const auto* const edit = std::get_if<CouplingEdit>(&form.action)) {
            CHECK_NOTHROW(with_settings({}, edit->settings));
        }
    }
}

TEST_CASE("a setting that no coupling has is refused with those that it has",
          "[scene][edits][errors]") {
    struct Row {
        const char* setting;
        const char* message;
    };
    const auto row = GENERATE(values<Row>({
        {"mod=3", "setting coupling.mod=3: unknown key 'coupling.mod'; did you mean 'mode'?"},
        {"fly=3",
         "setting coupling.fly=3: unknown key 'coupling.fly'; expected one of mode, clamp_N, "},
        {"hand.grip=firm", "unknown key 'coupling.hand'; expected one of mode, clamp_N, "},
        {"mode=7", "setting coupling.mode=7: 'coupling.mode' is 7; expected one of 1, 2, 3, 4, 5,"},
        {"clamp_N=4", "'coupling.clamp_N' is 4; expected a number from 0 to 3.3"},
        {"clamp_N=nan", "expected a finite number"},
        // Against what the coupling has already.
        {"F_h2_N=0.5", "'coupling.F_h2_N' is 0.5 N; expected more than F_h1_N, 1 N"},
        {"F_h1_N=4", "setting coupling.F_h1_N=4: 'coupling.F_h2_N' is 3 N; expected more than"},
        {"mode", "expected KEY=VALUE"},
        {"=3", "'coupling.' is not a key"},
        {"mode=[", "the value is not valid TOML"},
        {"mode=1\n", "setting: a setting has characters that cannot be printed"},
        {"", "expected KEY=VALUE"},
    }));
    INFO(row.setting);

    CHECK_THAT(test::load_error_of(
                   [&] { (void)with_settings({}, std::vector<std::string>{row.setting}); }),
               Contains(row.message) && StartsWith("setting"));
}

TEST_CASE("the files of an edit are those that it names", "[scene][edits]") {
    EditAction none = GrabEdit{"a"}, residue = AddEdit{"TIP3", "", "w", {}},
               one = AddEdit{"", "", "w", {}, "a.crd"},
               both = AddEdit{"", "", "w", {}, "a.crd", "b.psf", "A"};

    CHECK(list_files(none).empty());
    CHECK(list_files(residue).empty());
    REQUIRE(list_files(one).size() == 1);
    CHECK(*list_files(one)[0] == "a.crd");
    REQUIRE(list_files(both).size() == 2);
    *list_files(both)[1] = "c.psf";
    CHECK(std::get<AddEdit>(both).topology == "c.psf");
}
