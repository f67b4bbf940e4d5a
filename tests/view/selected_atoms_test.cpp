#include "view/selected_atoms.h"

#include "core/load_error.h"
#include "loading/load.h"
#include "molecule/select.h"
#include "scene/read_scene.h"
#include "simulation/resources.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "view/build_frame.h"
#include "view/palette.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;

namespace {

// Two molecules: "a" of residues 1 (two atoms), 2 (one), 3, 4 and 4A (one each), "water" of one.
AtomDirectory small_directory() {
    AtomDirectory directory;
    directory.names = {{"A", "GLY", "1", "N"},   {"A", "GLY", "1", "CA"}, {"A", "ALA", "2", "N"},
                       {"A", "ALA", "3", "N"},   {"A", "ALA", "4", "N"},  {"A", "SER", "4A", "O5'"},
                       {"W", "TIP3", "1", "OH2"}};
    directory.molecules = {{"a", {0, 6}, 0}, {"water", {6, 1}, 6}};
    number_residues(directory);
    return directory;
}

std::vector<bool> atoms(std::initializer_list<std::size_t> chosen, std::size_t count = 7) {
    std::vector<bool> all(count, false);
    for (const std::size_t i : chosen) all[i] = true;
    return all;
}

std::vector<bool> select(const AtomDirectory& directory, const std::string& text) {
    AtomTable table;
    table.names = directory.names;
    table.positions.assign(table.names.size(), Vec3::Zero());
    std::vector<NamedRange> molecules;
    for (const auto& entry : directory.molecules)
        molecules.push_back({entry.molecule, entry.atoms});
    return select_atoms(parse_selection(text), {table, molecules});
}

// Spheres at pixels of a picture of 200 x 100 that looks along -z, 10 Å from z = 0.
FrameScene flat_frame(const std::vector<glm::vec3>& places) {
    FrameScene frame;
    for (std::size_t i = 0; i < places.size(); ++i)
        frame.spheres.push_back({places[i], 0.1F, {1, 1, 1}, static_cast<std::uint32_t>(i)});
    return frame;
}

}  // namespace

TEST_CASE("what is selected is counted in residues and atoms", "[view][selection]") {
    const AtomDirectory directory = small_directory();
    CHECK(describe_count(directory, atoms({0, 1, 2, 5})) == "3 residues, 4 atoms");
    CHECK(describe_count(directory, atoms({1})) == "1 residue, 1 atom");
    CHECK(describe_count(directory, atoms({5, 6})) == "2 residues, 2 atoms");
    CHECK(describe_count(directory, atoms({})) == "0 residues, 0 atoms");
}

TEST_CASE("chosen atoms become an expression that selects their residues", "[view][selection]") {
    const AtomDirectory directory = small_directory();
    CHECK(expression_of(directory, atoms({1})) == "molecule a and resid 1 and name CA");
    CHECK(expression_of(directory, atoms({0, 1})) == "molecule a and resid 1");
    CHECK(expression_of(directory, atoms({1, 2, 3, 5})) == "molecule a and resid 1:3 4A");
    CHECK(expression_of(directory, atoms({0, 2, 6})) ==
          "molecule a and resid 1 2 or molecule \"water\"");
    CHECK(expression_of(directory, atoms({})) == "none");
    CHECK(expression_of(directory, 5U) == "molecule a and resid 4A and name \"O5'\"");

    CHECK(select(directory, expression_of(directory, atoms({1, 2, 3, 5}))) ==
          atoms({0, 1, 2, 3, 5}));
    CHECK(select(directory, expression_of(directory, atoms({0, 2, 6}))) == atoms({0, 1, 2, 6}));
    for (std::uint32_t i = 0; i < 7; ++i)
        CHECK(select(directory, expression_of(directory, i)) == atoms({i}));
}

TEST_CASE("a range does not reach to residues with letters that are not chosen",
          "[view][selection]") {
    const AtomDirectory directory = small_directory();
    const std::vector<bool> without = atoms({0, 1, 2, 3, 4}), with = atoms({0, 1, 2, 3, 4, 5});

    CHECK(expression_of(directory, without) == "molecule a and resid 1:3 4");
    CHECK(select(directory, expression_of(directory, without)) == without);
    CHECK(select(directory, expression_of(directory, with)) == with);
    CHECK(select(directory, "molecule a and resid 1:4") == with);
}

TEST_CASE("atoms beyond the end of what is chosen are not chosen", "[view][selection]") {
    const AtomDirectory directory = small_directory();
    CHECK(describe_count(directory, atoms({1}, 2)) == "1 residue, 1 atom");
    CHECK(expression_of(directory, atoms({1}, 2)) == "molecule a and resid 1 and name CA");
    CHECK(expression_of(directory, atoms({8}, 9)) == "none");
}

TEST_CASE("a box selects what is shown and seen in it", "[view][selection]") {
    // At a distance of 10 Å a picture of 100 pixels is 2 · 10 · tan 0.3 = 6.187 Å high.
    const std::vector<glm::vec3> places{{0, 0, 0},      // in the middle, (100, 50)
                                        {1, 0, 0},      // 16.2 pixels to the right
                                        {0, 1, 0},      // 16.2 above
                                        {0, 0, 20},     // behind the eye
                                        {0.1F, 0, 0}};  // not shown
    FrameScene frame = flat_frame({places.begin(), places.end() - 1});

    const auto in_box = [&](glm::vec2 one, glm::vec2 other) {
        return find_in_box(frame, places, {one, other}, 200, 100);
    };
    CHECK(in_box({99, 49}, {101, 51}) == atoms({0}, 5));
    CHECK(in_box({117, 55}, {99, 45}) == atoms({0, 1}, 5));  // any two corners
    CHECK(in_box({115, 45}, {99, 55}) == atoms({0}, 5));
    CHECK(in_box({95, 51}, {105, 33}) == atoms({0, 2}, 5));
    CHECK(in_box({0, 0}, {200, 100}) == atoms({0, 1, 2}, 5));
    frame.spheres.clear();
    frame.cones.push_back({places[1], places[2], 0.1F, 0.1F, {}, {}, 1});
    frame.meshes.push_back({.vertices = {{.place = places[0], .pick = 2}}});
    CHECK(in_box({0, 0}, {200, 100}) == atoms({1, 2}, 5));
}

TEST_CASE("what is selected is tinted, of ribbons whole residues, and dots where nothing is shown",
          "[view][selection]") {
    const AtomDirectory directory = small_directory();
    const std::vector<glm::vec3> places(7, glm::vec3(1, 2, 3));
    FrameScene frame = flat_frame({{0, 0, 0}, {1, 0, 0}});  // residue 1
    frame.meshes.push_back({.vertices = {{.pick = 1}, {.pick = 2}}});
    frame.spheres.push_back({{0, 0, 0}, 1, {1, 1, 1}, UINT32_MAX - 1});  // a sign

    highlight(directory, places, atoms({0, 3}), frame);

    const glm::vec3 white(1), tinted = 0.25F * white + 0.75F * selected_colour;
    CHECK(glm::distance(frame.spheres[0].colour, tinted) < 1e-6);
    CHECK(frame.spheres[0].radius == Approx(0.13));
    CHECK(frame.spheres[1].radius == 0.1F);
    CHECK(frame.spheres[1].colour == white);
    CHECK(frame.spheres[2].colour == white);
    CHECK(glm::distance(frame.meshes[0].vertices[0].colour, tinted) < 1e-6);
    CHECK(frame.meshes[0].vertices[1].colour == white);
    REQUIRE(frame.spheres.size() == 4);
    CHECK(frame.spheres[3].pick == 3);
    CHECK(frame.spheres[3].centre == places[3]);
}

TEST_CASE("atoms of a world are selected as pictures see them, and errors have a column",
          "[view][selection]") {
    const World world =
        load_world(read_scene(test::in_project("scenes/hiv"), std::vector<std::string>()));
    const std::vector<AtomName>& names = world.resource<AtomTable>().names;

    // The protease's one helix in each chain is at its end, residues 86 to 94 (PDB 1HSG and kin).
    const std::vector<bool> helix = select_as_seen(world, "helix and name CA");
    std::size_t right = 0, count = 0;
    for (std::size_t i = 0; i < helix.size(); ++i) {
        if (!helix[i]) continue;
        ++count;
        const int number = std::stoi(names[i].number);
        right += number >= 86 && number <= 95 ? 1 : 0;
    }
    CHECK(count >= 6);
    CHECK(right * 10 >= count * 9);
    CHECK_THAT(test::load_error_of([&] { (void)select_as_seen(world, "protein and resnam X"); }),
               Contains("column 13"));
}

TEST_CASE("hidden atoms are drawn by layers alone", "[view][selection]") {
    const World world =
        load_world(read_scene(test::in_project("scenes/water"), std::vector<std::string>()));
    ViewSettings settings{.force_arrow = false, .hydrogen_bonds = ShownBonds::None};
    CHECK(build_frame(world, settings).spheres.size() == 6);
    settings.hidden = {"molecule fixed"};
    CHECK(build_frame(world, settings).spheres.size() == 3);
    settings.layers = {{.representation = Representation::SpaceFilling, .of = "name OH2"}};
    CHECK(build_frame(world, settings).spheres.size() == 5);
}
