// Scenes of this format, of older and of newer ones.
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

}  // namespace

TEST_CASE("names of today need no note, with a number and without", "[scene][format]") {
    const std::string head = GENERATE("", "format = \"2\"", "format = \"2.0\"");

    const SceneDescription read =
        parse_scene(scene_text(head, "[view]\ncolour = \"element\"\n"), water_file);

    CHECK(read.view.colouring == Colouring::Element);
    CHECK(read.notes.empty());
}

TEST_CASE("of a newer minor format what is unknown is left out with a note", "[scene][format]") {
    const std::string later =
        "[view]\nsparkle = 3\nrepresentation = \"hologram\"\ncolour = \"element\"\n[weather]\nwind "
        "= 1\n";

    const SceneDescription read = parse_scene(scene_text("format = \"2.99\"", later), water_file);

    CHECK(read.view.colouring == Colouring::Element);
    CHECK(read.view.representation == SceneDescription().view.representation);
    REQUIRE(read.notes.size() == 4);
    CHECK_THAT(read.notes[0], Contains("scene format 2.99 is newer than 2.2"));
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

TEST_CASE("another major format is refused with what to do, whatever else is wrong",
          "[scene][format]") {
    CHECK_THAT(refusal_of("[later]\nkey = 1\n" + scene_text("")), Contains("unknown key 'later'"));
    CHECK_THAT(
        refusal_of(scene_text("format = \"3.0\"", "[later]\nkey = 1\n")),
        Contains("scene format 3.0 is newer than this program reads") && Contains("a newer Palpa"));
    CHECK_THAT(refusal_of(scene_text("format = \"1\"")),
               Contains("scene format 1.0 is older than this program reads; expected format 2.2"));
    CHECK_THAT(refusal_of(scene_text("format = \"two\"")), Contains("expected a version, \"2.2\""));
    CHECK_THAT(refusal_of(scene_text("format = 2")),
               Contains("'format' is 2; expected text in quotes"));
}

TEST_CASE("a written scene states this format and reads without a note", "[scene][format]") {
    const SceneDescription read =
        parse_scene(scene_text("", "[view]\ncolour = \"element\"\n"), water_file);

    const std::string written =
        format_scene(read, [](const std::filesystem::path& path) { return path.string(); });

    CHECK(written.starts_with(fmt::format("format = \"{}\"\n", to_string(scene_version))));
    const SceneDescription back = parse_scene(written, water_file);
    CHECK(back.notes.empty());
    CHECK(back.view.colouring == Colouring::Element);
}
