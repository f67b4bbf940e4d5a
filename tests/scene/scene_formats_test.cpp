// Scenes of the format before, of this one and of newer ones. Old names are those that scenes in
// git's history have: tests/data/README.md.
#include "core/file_versions.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <variant>

using namespace palpa;
using Catch::Matchers::Contains;
using test::load_error_of;

namespace {

const std::string water_file = test::in_project("scenes/water/test.toml");

// `head`: lines before all tables.
std::string scene_text(const std::string& head, const std::string& tables = "") {
    return head + R"(
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
)" + tables;
}

std::string refusal_of(const std::string& text) {
    return load_error_of([&] { (void)parse_scene(text, water_file); });
}

const std::string old_names = R"([statics]
weights = "near-hand"
[view]
colouring = "element"
[[edits]]
at_s = 1
appearance = { molecule = "moved", colouring = "chain" }
)";

}  // namespace

TEST_CASE("a scene of format 1 has its old names, each with a note", "[scene][format]") {
    const std::string head = GENERATE("", "format = \"1\"", "format = \"1.0\"");

    const SceneDescription read = parse_scene(scene_text(head, old_names), water_file);

    CHECK(read.statics.weights == JointWeights::HandProximity);
    CHECK(read.view.colouring == Colouring::Element);
    REQUIRE(read.edits.size() == 1);
    const auto* const look = std::get_if<AppearanceEdit>(&read.edits[0].action);
    REQUIRE(look);
    CHECK(look->colouring == Colouring::Chain);
    REQUIRE(read.notes.size() == 3);
    CHECK_THAT(read.notes[0], Contains(":17:") && Contains("near-hand is now hand-proximity"));
    CHECK_THAT(read.notes[1], Contains(":19:1: 'view.colouring' is now 'view.colour'"));
    CHECK_THAT(read.notes[2], Contains(":22:") && Contains("appearance.colour'"));
}

TEST_CASE("every old value is read as the new one", "[scene][format]") {
    struct Row {
        const char* before;
        JointWeights now;
    };
    const Row row =
        GENERATE(Row{"plain", JointWeights::Acceleration}, Row{"single", JointWeights::PerJoint},
                 Row{"light", JointWeights::InverseMovedAtoms},
                 Row{"near-hand", JointWeights::HandProximity});

    const SceneDescription read = parse_scene(
        scene_text("", fmt::format("[statics]\nweights = \"{}\"\n", row.before)), water_file);

    CHECK(read.statics.weights == row.now);
}

TEST_CASE("names of today need no note, with a number and without", "[scene][format]") {
    const std::string head = GENERATE("", "format = \"1\"", "format = \"2\"", "format = \"2.0\"");

    const SceneDescription read =
        parse_scene(scene_text(head, "[view]\ncolour = \"element\"\n"), water_file);

    CHECK(read.view.colouring == Colouring::Element);
    CHECK(read.notes.empty());
}

TEST_CASE("a scene of this format has no old names", "[scene][format]") {
    const std::string head = "format = \"2.0\"";

    CHECK_THAT(refusal_of(scene_text(head, "[view]\ncolouring = \"element\"\n")),
               Contains("'view.colouring' is now 'view.colour'"));
    CHECK_THAT(refusal_of(scene_text(head, "[statics]\nweights = \"near-hand\"\n")),
               Contains("'statics.weights': near-hand is now hand-proximity"));
}

TEST_CASE("an old name beside the new one is unknown", "[scene][format]") {
    CHECK_THAT(refusal_of(scene_text("", "[view]\ncolouring = \"element\"\ncolour = \"chain\"\n")),
               Contains("unknown key 'view.colouring'"));
}

TEST_CASE("of a newer minor format what is unknown is left out with a note", "[scene][format]") {
    const std::string later =
        "[view]\nsparkle = 3\nrepresentation = \"hologram\"\ncolour = \"element\"\n[weather]\nwind "
        "= 1\n";

    const SceneDescription read = parse_scene(scene_text("format = \"2.99\"", later), water_file);

    CHECK(read.view.colouring == Colouring::Element);
    CHECK(read.view.representation == SceneDescription().view.representation);
    REQUIRE(read.notes.size() == 4);
    CHECK_THAT(read.notes[0], Contains("scene format 2.99 is newer than 2.0"));
    CHECK_THAT(read.notes[1],
               Contains("'view.representation' is the text \"hologram\"") && Contains("left out"));
    CHECK_THAT(read.notes[2], Contains("the key 'view.sparkle'"));
    CHECK_THAT(read.notes[3], Contains("the key 'weather'"));
    CHECK_THAT(refusal_of(scene_text("format = \"2.0\"", later)), Contains("unknown key"));
}

TEST_CASE(
    "of a newer minor format an edit of an unknown kind is refused, for nothing is left of it",
    "[scene][format]") {
    const std::string edit = "[[edits]]\nat_s = 1\nevaporate = { molecule = \"moved\" }\n";

    CHECK_THAT(refusal_of(scene_text("format = \"2.99\"", edit)),
               Contains("has none of the keys") && Contains("expected one of them"));
}

TEST_CASE("a newer major format is refused with what to do, whatever else is wrong",
          "[scene][format]") {
    CHECK_THAT(refusal_of("[later]\nkey = 1\n" + scene_text("")), Contains("unknown key 'later'"));
    CHECK_THAT(
        refusal_of(scene_text("format = \"3.0\"", "[later]\nkey = 1\n")),
        Contains("scene format 3.0 is newer than this program") && Contains("a newer Palpa"));
    CHECK_THAT(refusal_of(scene_text("format = \"0.5\"")), Contains("does not exist"));
    CHECK_THAT(refusal_of(scene_text("format = \"two\"")), Contains("expected a version, \"2.0\""));
    CHECK_THAT(refusal_of(scene_text("format = 2")),
               Contains("'format' is 2; expected text in quotes"));
}

TEST_CASE("a written scene states this format and reads without a note", "[scene][format]") {
    const SceneDescription read = parse_scene(scene_text("", old_names), water_file);

    const std::string written =
        format_scene(read, [](const std::filesystem::path& path) { return path.string(); });

    CHECK(written.starts_with(fmt::format("format = \"{}\"\n", to_string(scene_version))));
    CHECK(written.find("colouring") == std::string::npos);
    const SceneDescription back = parse_scene(written, water_file);
    CHECK(back.notes.empty());
    CHECK(back.statics.weights == JointWeights::HandProximity);
    CHECK(back.view.colouring == Colouring::Element);
}

TEST_CASE("a scene file from before formats had numbers is read", "[scene][format]") {
    const SceneDescription read = read_scene(test::in_project("tests/data/format-1/scene.toml"));

    CHECK(read.view.colouring == Colouring::Element);
    CHECK(read.statics.weights == JointWeights::PerJoint);
    CHECK(read.notes.size() == 2);
}

TEST_CASE("an edit has the names of the format that is stated for it", "[scene][format]") {
    const std::string edit =
        "[[edits]]\nat_s = 0\nappearance = { molecule = \"moved\", colouring = \"chain\" }\n";

    const EditDescription read = parse_edit(edit, {water_file, 7}, unnumbered_version);

    CHECK(std::get<AppearanceEdit>(read.action).colouring == Colouring::Chain);
    CHECK_THAT(load_error_of([&] { (void)parse_edit(edit, {water_file, 7}); }),
               Contains("is now 'edits[1].appearance.colour'"));
}
