// Scenes of several hands: [[hand]] tables, and [second.grab] with [second.hand] as before 2.2.
#include "scene/fields.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string two_hands_file = test::in_project("scenes/water/test.toml");

// 21 lines, so that what is added stands from line 22 on.
const std::string two_hands = R"([force_field]
files = ["tip3p.str"]
[molecules.fixed]
structure = "dimer.crd"
segment = "FIX"
reference_atom = "OH2"
[molecules.moved]
structure = "dimer.crd"
segment = "MOV"
reference_atom = "OH2"
motion = "translate"
[molecules.other]
structure = "dimer.crd"
segment = "MOV"
reference_atom = "OH2"
motion = "translate"
[grab]
molecule = "moved"
measured_from = "fixed"
[second.grab]
molecule = "other"
measured_from = "fixed"
)";

HandDescription hand_with(GrabDescription grab) {
    HandDescription hand;
    hand.grab = std::move(grab);
    return hand;
}

SceneDescription read_two(const std::string& more, const std::vector<std::string>& settings = {}) {
    return parse_scene(two_hands + more, two_hands_file, settings);
}

std::string two_hands_error(const std::string& text,
                            const std::vector<std::string>& settings = {}) {
    return test::load_error_of([&] { (void)parse_scene(text, two_hands_file, settings); });
}

std::string with_other(const std::string& old, const std::string& by) {
    std::string text = two_hands;
    const std::size_t place = text.rfind(old);
    REQUIRE(place != std::string::npos);
    return text.replace(place, old.size(), by);
}

std::string write_two(const SceneDescription& scene) {
    const std::filesystem::path folder = test::in_project("scenes/water");
    return format_scene(scene, [&](const std::filesystem::path& input) {
        return input.lexically_relative(folder).string();
    });
}

}  // namespace

TEST_CASE("a second hand has what the first has, with its defaults", "[scene][second]") {
    const SceneDescription scene = read_two("");

    REQUIRE(scene.hands.size() == 2);
    CHECK(scene.hands[1].grab == GrabDescription{"other", "fixed", "", 20});
    CHECK(scene.hands[1] == hand_with(scene.hands[1].grab));
    CHECK(scene.hands.front().grab.molecule == "moved");
    const std::string one = two_hands.substr(0, two_hands.find("[second"));
    CHECK(parse_scene(one.substr(0, one.find("[molecules.other]")) + one.substr(one.find("[grab]")),
                      two_hands_file)
              .hands.size() == 1);
}

TEST_CASE("all keys of a second hand are read, and read the same once written", "[scene][second]") {
    const SceneDescription scene =
        parse_scene(with_other("[second.grab]\nmolecule = \"other\"\nmeasured_from = \"fixed\"\n",
                               R"([second.grab]
molecule = "other"
measured_from = "fixed"
atom = "1 OH2"
spring_kcal_per_mol_angstrom2 = 3.5
[second.hand]
grip = "firm"
stroke = "path"
start_offset_angstrom = [1, 2, 0.1]
peak_nN = 2
stroke_s = 4
pause_s = 5
cycles = 6
release_s = 7
kick_N_s = 0.05
path = [[0, 1], [2, 3, 4, 5]]
)")
                        .replace(two_hands.rfind("\"translate\""), 11, "\"free\""),
                    two_hands_file);

    const HandDescription expected{.grab = {"other", "fixed", "1 OH2", 3.5},
                                   .grip = HandGrip::Firm,
                                   .stroke = Stroke::Path,
                                   .start_angstrom = {},
                                   .start_offset_angstrom = {1, 2, 0.1},
                                   .peak_nN = 2,
                                   .stroke_s = 4,
                                   .pause_s = 5,
                                   .cycles = 6,
                                   .release_s = 7,
                                   .kick_N_s = 0.05,
                                   .path = {{0, {1, 0, 0}, {}}, {2, {3, 4, 5}, {}}}};
    REQUIRE(scene.hands.size() == 2);
    CHECK(scene.hands[1] == expected);
    CHECK(scene.hands[0] == hand_with({"moved", "fixed", "", 20}));

    const std::string text = write_two(scene);
    INFO(text);
    const SceneDescription back = parse_scene(text, two_hands_file);
    CHECK(back.hands == scene.hands);
    CHECK(write_two(back) == text);
}

TEST_CASE("a scene of one hand is written without a second", "[scene][second]") {
    const SceneDescription one = read_scene(test::in_project("scenes/water"));

    CHECK_THAT(write_two(one), Contains("\n[grab]\n") && Contains("\n[hand]\n") &&
                                   !Contains("[[hand]]") && !Contains("[second"));
}

TEST_CASE("settings reach the second hand by keys in full", "[scene][second][settings]") {
    const SceneDescription scene = read_two("[second.hand]\npeak_nN = 2\n",
                                            {"second.hand.grip=firm", "second.grab.molecule=moved",
                                             "grip=light", "molecules.other.motion=fixed"});

    REQUIRE(scene.hands.size() == 2);
    CHECK(scene.hands[1].grip == HandGrip::Firm);
    CHECK(scene.hands[1].peak_nN == 2);
    CHECK(grip_names[static_cast<std::size_t>(scene.hands.front().grip)] ==
          "light");                                  // a bare name is one of the first hand
    CHECK(scene.hands[1].grab.molecule == "moved");  // both may hold the same
    CHECK(scene.place_of("hand[2].grip").file == "--set second.hand.grip=firm");

    // Where the file has none, settings bring one.
    const SceneDescription water = read_scene(
        test::in_project("scenes/water"),
        std::vector<std::string>{"second.grab.molecule=moved", "second.grab.measured_from=fixed"});
    REQUIRE(water.hands.size() == 2);
    CHECK(water.hands[1] == hand_with({"moved", "fixed", "", 20}));
    CHECK_THAT(test::load_error_of([] {
                   (void)read_scene(test::in_project("scenes/water"),
                                    std::vector<std::string>{"second.hand.grip=firm"});
               }),
               Contains("the table [hand[2].grab] is missing: what the hand holds"));
}

TEST_CASE("what the second hand holds and does is checked as with the first",
          "[scene][second][errors]") {
    const auto place = [](int line, int column) {
        return fmt::format("{}:{}:{}: ", two_hands_file, line, column);
    };

    CHECK_THAT(two_hands_error(with_other("molecule = \"other\"\n", "")),
               StartsWith(place(20, 1) + "the key 'hand[2].grab.molecule' is missing"));
    CHECK_THAT(two_hands_error(with_other("molecule = \"other\"", "molecule = \"othr\"")),
               StartsWith(place(21, 12) + "'hand[2].grab.molecule' is \"othr\", which is not") &&
                   Contains("did you mean 'other'?") &&
                   !Contains("; " + std::string(two_hands_file) + ":"));
    CHECK_THAT(two_hands_error(with_other("\"fixed\"", "\"moved\"")),
               StartsWith(place(22, 17) + "'hand[2].grab.measured_from' is \"moved\", whose"));
    CHECK_THAT(two_hands_error(with_other("\"translate\"", "\"free\"")),
               StartsWith(place(21, 12) + "'hand[2].grab.molecule' is \"other\", whose motion is "
                                          "\"free\"; expected a molecule that the hand can move"));
    CHECK_THAT(two_hands_error(two_hands + "atom = \"1\"\n"),
               Contains("expected a molecule that is free, or fixed and flexible, because the hand "
                        "pulls it by a spring (hand[2].grab.atom)"));
    CHECK_THAT(two_hands_error(with_other("\"other\"", "\"moved\"")),
               StartsWith(place(16, 10) + "'molecules.other.motion' is \"translate\", but no "
                                          "hand holds it (hand[N].grab.molecule)"));
    CHECK_THAT(two_hands_error(two_hands.substr(0, two_hands.find("[second"))),
               Contains("'molecules.other.motion' is \"translate\", but the hand moves only "
                        "grab.molecule;"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\nstart_angstrom = 3\n"),
               StartsWith(place(24, 18) +
                          "'hand[2].start_angstrom' applies to a molecule that moves along x"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\ngrip = \"none\"\n"),
               Contains("'hand[2].stroke' is \"in-out\", but with the grip \"none\""));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\nstroke = \"path\"\n"),
               StartsWith(place(24, 10) + "'hand[2].stroke' is \"path\", but "
                                          "'hand[2].path' has no point"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\npath = [[1, 0], [1, 2]]\n"),
               StartsWith(place(24, 8) + "'hand[2].path' has the time 1 s after 1 s"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\npeak_nN = -1\n"),
               StartsWith(place(24, 11) + "'hand[2].peak_nN' is -1; expected a number"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hands]\npeak_nN = 1\n"),
               Contains("unknown key 'hand[2].hands'"));
    CHECK_THAT(two_hands_error(two_hands.substr(0, two_hands.find("[second")) + "[second]\n"),
               Contains("the table [hand[2].grab] is missing"));
}

TEST_CASE("a second hand's spring makes a scene one of statics", "[scene][second]") {
    std::string text = with_other("\"translate\"", "\"fixed\"\nshape = \"flexible\"");
    CHECK(parse_scene(text + "atom = \"1\"\n", two_hands_file).has_statics());
    CHECK_FALSE(read_two("").has_statics());

    // Of a scene whose only unmet part is that spring's.
    SceneDescription scene = read_two("");
    scene.hands[1].grab.atom = "1";
    CHECK(scene.has_statics());
}

TEST_CASE("every key of a second hand is written", "[scene][second]") {
    SceneDescription scene = read_two("");
    HandDescription& hand = scene.hands[1];
    hand.start_angstrom = 3;
    hand.release_s = 4;
    hand.grab.place_angstrom = {1, 2, 3};
    hand.grab.released = Motion::Free;
    hand.device = DeviceDescription{.friction_N = 0.125};
    hand.coupling = CouplingDescription{.feel_pN = std::array{20.0, 300.0}, .feel_within_pN = 5};

    const std::string text = write_two(scene);
    INFO(text);
    const std::size_t first = text.find("\n[[hand]]\n"), second = text.rfind("\n[[hand]]\n");
    REQUIRE(first < second);
    const std::map<std::string_view, std::string_view> tables{{"hand", "\n[[hand]]\n"},
                                                              {"grab", "\n[hand.grab]\n"},
                                                              {"device", "\n[hand.device]\n"},
                                                              {"coupling", "\n[hand.coupling]\n"}};
    for (const FieldNote& field : list_fields()) {
        const std::string_view key = field.key;
        const auto header = tables.find(key.substr(0, key.find('.')));
        if (header == tables.end() || key.find('.') == key.npos) continue;
        const std::size_t table = text.find(header->second, second);
        INFO(key);
        REQUIRE(table != std::string::npos);
        const std::size_t end = text.find("\n\n", table + 1);
        CHECK(text.substr(table, end - table)
                  .find(fmt::format("\n{} = ", key.substr(key.find('.') + 1))) !=
              std::string::npos);
    }
    hand.start_angstrom.reset();  // of a molecule on a line
    hand.grab.place_angstrom.reset();
    CHECK(parse_scene(write_two(scene), two_hands_file).hands == scene.hands);
}

TEST_CASE("[[hand]] tables say what each hand has, as [grab] and [hand] do for one",
          "[scene][second]") {
    const std::string before = two_hands.substr(0, two_hands.find("[grab]"));
    const SceneDescription listed = parse_scene(before + R"([coupling]
clamp_N = 2.5
[[hand]]
grip = "firm"
[hand.grab]
molecule = "moved"
measured_from = "fixed"
[[hand]]
stroke = "hold"
[hand.grab]
molecule = "other"
measured_from = "fixed"
[hand.device]
friction_N = 0.125
[hand.coupling]
mode = 3
[[hand]]
stroke = "hold"
grab = { molecule = "", measured_from = "fixed" }
)",
                                                two_hands_file);

    REQUIRE(listed.hands.size() == 3);
    CHECK(listed.hands[0].grip == HandGrip::Firm);
    CHECK(listed.hands[0].grab.molecule == "moved");
    CHECK(listed.hands[2].grab.molecule.empty());
    // Its own device and coupling begin as the scene's.
    CHECK(device_of(listed, 1).friction_N == 0.125);
    CHECK(device_of(listed, 1).inertia_kg == listed.device.inertia_kg);
    CHECK(device_of(listed, 0) == listed.device);
    CHECK(coupling_of(listed, 1).mode != listed.coupling.mode);
    CHECK(coupling_of(listed, 1).clamp_N == 2.5);
    CHECK(coupling_of(listed, 2) == listed.coupling);

    const SceneDescription one = parse_scene(before.substr(0, before.find("[molecules.other]")) +
                                                 "[[hand]]\ngrip = \"firm\"\n[hand.grab]\n"
                                                 "molecule = \"moved\"\nmeasured_from = "
                                                 "\"fixed\"\n[hand.device]\nfriction_N = 0.125\n",
                                             two_hands_file);
    REQUIRE(one.hands.size() == 1);
    CHECK(one.hands[0].grip == HandGrip::Firm);
    CHECK(one.device.friction_N == 0.125);
    CHECK(one.place_of("hand.grip").line == 13);

    const SceneDescription table = parse_scene(
        before.substr(0, before.find("[molecules.other]")) +
            "[hand]\ngrip = \"firm\"\n[hand.grab]\nmolecule = \"moved\"\nmeasured_from = "
            "\"fixed\"\n[hand.device]\nfriction_N = 0.125\n",
        two_hands_file);
    CHECK(table.hands == one.hands);
    CHECK(table.device == one.device);
}

TEST_CASE("what must be felt is no hand's own unless its table has it", "[scene][second]") {
    const SceneDescription scene =
        read_two("[coupling]\nmode = \"guarded\"\nfeel_pN = [20, 1000]\nfeel_within_pN = 50\n",
                 {"hand[2].coupling.mode=3"});

    CHECK(coupling_of(scene, 0).feel_within_pN == 50);
    CHECK_FALSE(coupling_of(scene, 1).feel_within_pN);
    CHECK_FALSE(coupling_of(scene, 1).feel_pN);
    CHECK(parse_scene(write_two(scene), two_hands_file).hands == scene.hands);
}

TEST_CASE("settings without a number are those of the first hand", "[scene][second][settings]") {
    const std::vector<std::string> settings{
        "hand.grip=firm", "grab.spring_kcal_per_mol_angstrom2=7", "hand[2].peak_nN=5",
        "hand[2].coupling.mode=4", "hand[1].device.friction_N=0.5"};
    const SceneDescription two = read_two("", settings);
    CHECK(two.hands[0].grip == HandGrip::Firm);
    CHECK(two.hands[0].grab.spring_kcal_per_mol_angstrom2 == 7);
    CHECK(two.hands[1].peak_nN == 5);
    CHECK(coupling_of(two, 1).mode == CouplingMode::ConstantForceConstantDisplacement);
    CHECK(coupling_of(two, 0).mode == two.coupling.mode);
    CHECK(device_of(two, 0).friction_N == 0.5);
    CHECK(device_of(two, 1).friction_N == two.device.friction_N);
    CHECK(two.place_of("hand[2].peak_nN").file == "--set hand[2].peak_nN=5");

    const SceneDescription one = read_scene(
        test::in_project("scenes/water"),
        std::vector<std::string>{"hand[1].grip=firm", "hand[1].grab.measured_from=fixed"});
    CHECK(one.hands.size() == 1);
    CHECK(one.hands[0].grip == HandGrip::Firm);
    CHECK(one.place_of("hand.grip").file == "--set hand[1].grip=firm");

    // The coupling of hand[1] is its own also if the setting that adds hand[2] comes later.
    const SceneDescription added = read_scene(
        test::in_project("scenes/water/space.toml"),
        std::vector<std::string>{"hand.grab.measured_from=fixed", "hand[1].coupling.mode=3",
                                 "hand[2].grab.molecule=\"\"", "hand[2].grab.measured_from=fixed",
                                 "hand[2].stroke=hold"});
    REQUIRE(added.hands.size() == 2);
    CHECK(coupling_of(added, 0).mode == CouplingMode::ConstantForceVariableDisplacement);
    CHECK(coupling_of(added, 1) == added.coupling);
    CHECK(added.coupling.mode != coupling_of(added, 0).mode);

    const auto error_of = [](const std::string& setting) {
        return test::load_error_of([&] { (void)read_two("", {setting}); });
    };
    CHECK_THAT(
        error_of("hand[4].grip=firm"),
        Contains("--set hand[4].grip=firm: the scene has no hand[4]; expected hand[1] to hand[3]"));
    CHECK_THAT(error_of("hand[0].grip=firm"), Contains("the scene has no hand[0]"));
    CHECK_THAT(error_of("hand[3].grip=firm"), Contains("the table [hand[3].grab] is missing"));
    CHECK_THAT(error_of("hand[2].coupling.F_h2_N=0.5"),
               Contains("'hand[2].coupling.F_h2_N' is 0.5 N; expected more than F_h1_N"));
}

TEST_CASE("lists of hands that cannot be are refused", "[scene][second][errors]") {
    const std::string before = two_hands.substr(0, two_hands.find("[grab]"));
    const std::string hand =
        "[[hand]]\nstroke = \"hold\"\ngrab = { molecule = \"\", measured_from = \"fixed\" }\n";
    CHECK_THAT(two_hands_error(before + hand + hand + hand + hand + hand),
               Contains("'hand' has 5 entries; expected 1 to 4 tables [[hand]]"));
    CHECK_THAT(two_hands_error("hand = []\n" + before),
               Contains("'hand' has 0 entries; expected 1 to 4"));
    CHECK_THAT(two_hands_error(before +
                               "[grab]\nmolecule = \"moved\"\nmeasured_from = \"fixed\"\n" + hand),
               Contains("the first hand has a table [grab]"));
    CHECK_THAT(two_hands_error(before + "[grab]\nmolecule = \"moved\"\n[hand]\ngrab = {molecule = "
                                        "\"other\"}\n"),
               Contains("table [grab] and a table [hand.grab]; expected one"));
    CHECK_THAT(two_hands_error("hand = 3\n" + two_hands),
               Contains("'hand' is 3; expected a table, [hand]"));
    CHECK_THAT(two_hands_error("hand = [3, 4]\n" + before),
               Contains("'hand[1]' is 3; expected a table"));
    CHECK_THAT(two_hands_error(before + hand + hand + "[second.grab]\nmolecule = \"moved\"\n"),
               Contains("unknown key 'second'"));
}
