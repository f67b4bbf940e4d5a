// [second.grab] and [second.hand]: a hand of its own, by the rules of the first.
#include "scene/fields.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <string_view>
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

    REQUIRE(scene.second);
    CHECK(scene.second->grab == GrabDescription{"other", "fixed", "", 20});
    CHECK(scene.second->hand == HandDescription{});
    CHECK(scene.grab.molecule == "moved");
    const std::string one = two_hands.substr(0, two_hands.find("[second"));
    CHECK_FALSE(
        parse_scene(one.substr(0, one.find("[molecules.other]")) + one.substr(one.find("[grab]")),
                    two_hands_file)
            .second);
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

    const HandDescription expected{.grip = HandGrip::Firm,
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
    REQUIRE(scene.second);
    CHECK(scene.second->grab == GrabDescription{"other", "fixed", "1 OH2", 3.5});
    CHECK(scene.second->hand == expected);
    CHECK(scene.hand == HandDescription{});

    const std::string text = write_two(scene);
    INFO(text);
    const SceneDescription back = parse_scene(text, two_hands_file);
    CHECK(back.second == scene.second);
    CHECK(back.grab == scene.grab);
    CHECK(back.hand == scene.hand);
    CHECK(write_two(back) == text);
}

TEST_CASE("a scene of one hand is written without a second", "[scene][second]") {
    const SceneDescription one = read_scene(test::in_project("scenes/water"));

    CHECK_THAT(write_two(one), !Contains("[second"));
}

TEST_CASE("settings reach the second hand by keys in full", "[scene][second][settings]") {
    const SceneDescription scene = read_two("[second.hand]\npeak_nN = 2\n",
                                            {"second.hand.grip=firm", "second.grab.molecule=moved",
                                             "grip=light", "molecules.other.motion=fixed"});

    REQUIRE(scene.second);
    CHECK(grip_names[static_cast<std::size_t>(scene.second->hand.grip)] == "firm");
    CHECK(scene.second->hand.peak_nN == 2);
    CHECK(grip_names[static_cast<std::size_t>(scene.hand.grip)] ==
          "light");                                 // a bare name is one of the first hand
    CHECK(scene.second->grab.molecule == "moved");  // both may hold the same
    CHECK(scene.place_of("second.hand.grip").file == "--set second.hand.grip=firm");

    // Where the file has none, settings bring one.
    const SceneDescription water = read_scene(
        test::in_project("scenes/water"),
        std::vector<std::string>{"second.grab.molecule=moved", "second.grab.measured_from=fixed"});
    CHECK(water.second == SecondHand{{"moved", "fixed", "", 20}, {}});
    CHECK_THAT(test::load_error_of([] {
                   (void)read_scene(test::in_project("scenes/water"),
                                    std::vector<std::string>{"second.hand.grip=firm"});
               }),
               Contains("the table [second.grab] is missing: what a second hand holds"));
}

TEST_CASE("what the second hand holds and does is checked as with the first",
          "[scene][second][errors]") {
    const auto place = [](int line, int column) {
        return fmt::format("{}:{}:{}: ", two_hands_file, line, column);
    };

    CHECK_THAT(two_hands_error(with_other("molecule = \"other\"\n", "")),
               StartsWith(place(20, 1) + "the key 'second.grab.molecule' is missing"));
    CHECK_THAT(two_hands_error(with_other("molecule = \"other\"", "molecule = \"othr\"")),
               StartsWith(place(21, 12) + "'second.grab.molecule' is \"othr\", which is not") &&
                   Contains("did you mean 'other'?") &&
                   !Contains("; " + std::string(two_hands_file) + ":"));
    CHECK_THAT(two_hands_error(with_other("\"fixed\"", "\"moved\"")),
               StartsWith(place(22, 17) + "'second.grab.measured_from' is \"moved\", whose"));
    CHECK_THAT(two_hands_error(with_other("\"translate\"", "\"free\"")),
               StartsWith(place(21, 12) + "'second.grab.molecule' is \"other\", whose motion is "
                                          "\"free\"; expected a molecule that the hand can move"));
    CHECK_THAT(two_hands_error(two_hands + "atom = \"1\"\n"),
               Contains("expected a molecule that is free, or fixed and flexible, because the hand "
                        "pulls it by a spring (second.grab.atom)"));
    CHECK_THAT(two_hands_error(with_other("\"other\"", "\"moved\"")),
               StartsWith(place(16, 10) + "'molecules.other.motion' is \"translate\", but the "
                                          "hands move only grab.molecule and second.grab"));
    CHECK_THAT(two_hands_error(two_hands.substr(0, two_hands.find("[second"))),
               Contains("'molecules.other.motion' is \"translate\", but the hand moves only "
                        "grab.molecule;"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\nstart_angstrom = 3\n"),
               StartsWith(place(24, 18) +
                          "'second.hand.start_angstrom' applies to a molecule that moves along x"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\ngrip = \"none\"\n"),
               Contains("'second.hand.stroke' is \"in-out\", but with the grip \"none\""));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\nstroke = \"path\"\n"),
               StartsWith(place(24, 10) + "'second.hand.stroke' is \"path\", but "
                                          "'second.hand.path' has no point"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\npath = [[1, 0], [1, 2]]\n"),
               StartsWith(place(24, 8) + "'second.hand.path' has the time 1 s after 1 s"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hand]\npeak_nN = -1\n"),
               StartsWith(place(24, 11) + "'second.hand.peak_nN' is -1; expected a number"));
    CHECK_THAT(two_hands_error(two_hands + "[second.hands]\npeak_nN = 1\n"),
               Contains("unknown key 'second.hands'; did you mean 'hand'?"));
    CHECK_THAT(two_hands_error(two_hands.substr(0, two_hands.find("[second")) + "[second]\n"),
               Contains("the table [second.grab] is missing"));
}

TEST_CASE("a second hand's spring makes a scene one of statics", "[scene][second]") {
    std::string text = with_other("\"translate\"", "\"fixed\"\nshape = \"flexible\"");
    CHECK(parse_scene(text + "atom = \"1\"\n", two_hands_file).has_statics());
    CHECK_FALSE(read_two("").has_statics());

    // Of a scene whose only unmet part is that spring's.
    SceneDescription scene = read_two("");
    scene.second->grab.atom = "1";
    CHECK(scene.has_statics());
}

TEST_CASE("every key of a second hand is written", "[scene][second]") {
    SceneDescription scene = read_two("");
    scene.second->hand.start_angstrom = 3;
    scene.second->hand.release_s = 4;
    scene.second->grab.place_angstrom = {1, 2, 3};
    scene.second->grab.released = Motion::Free;

    const std::string text = write_two(scene);
    for (const FieldNote& field : list_fields()) {
        const std::string_view key = field.key;
        if (!key.starts_with("grab.") && !key.starts_with("hand.")) continue;
        const std::size_t dot = key.find('.');
        const std::size_t table = text.find(fmt::format("\n[second.{}]\n", key.substr(0, dot)));
        REQUIRE(table != std::string::npos);
        const std::size_t end = text.find("\n\n", table + 1);
        INFO(key);
        CHECK(text.substr(table, end - table).find(fmt::format("\n{} = ", key.substr(dot + 1))) !=
              std::string::npos);
    }
}
