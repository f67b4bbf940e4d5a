#include "session/save_scene.h"

#include "core/files.h"
#include "core/text.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/commands.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/step.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
namespace fs = std::filesystem;

namespace {

const std::vector<std::string> anywhere{std::string(allow_outside)};

// Lists all but the coordinates: atoms, molecules, looks, hands, springs and marks.
std::string describe_identity(const World& world) {
    std::string text;
    const AtomTable& atoms = world.resource<AtomTable>();
    const auto part = [&](const AtomsOf& of) {
        return fmt::format("{}:{}", world.find<Molecule>(of.molecule)->name,
                           fmt::join(of.atoms, ","));
    };
    for (std::size_t i = 0; i < atoms.size(); ++i)
        text += fmt::format("{} {} {} {:.6f} {:.4f} {}\n", atoms.names[i].residue,
                            atoms.names[i].number, atoms.names[i].atom, atoms.charge[i],
                            atoms.mass[i], atoms.type_names[atoms.type[i]]);
    world.each<Molecule, Mobility>([&](Entity entity, const Molecule& m, const Mobility& mobility) {
        text += fmt::format("{} {} {} {} {} {}\n", m.name, m.atoms.first, m.atoms.count,
                            m.reference_atom, static_cast<int>(mobility.motion),
                            static_cast<int>(mobility.shape));
        if (const Appearance* const look = world.find<Appearance>(entity))
            text += fmt::format("look {} {} {}\n", look->representation.has_value(),
                                look->colouring.has_value(), look->visible);
    });
    for (const Entity hand : find_hands(world)) {
        const Grip* const grip = world.find<Grip>(hand);
        text += grip ? fmt::format("holds {} {} {}\n", part(held_part_of(world, hand)),
                                   grip->freedom, static_cast<int>(grip->before.motion))
                     : "holds nothing\n";
    }
    world.each<Spring>([&](Entity, const Spring& spring) {
        text += "spring";
        for (const AtomsOf& end : spring.ends) text += " " + part(end);
        text += fmt::format(" {} {}\n", spring.k, spring.length);
    });
    world.each<Mark>([&](Entity, const Mark& mark) {
        for (const AtomsOf& atoms : mark.atoms) text += "mark " + part(atoms) + "\n";
    });
    return text;
}

// Moves what the first hand holds, by one of these ways (Å) in each step.
void pull(World& world, const std::vector<Vec3>& ways) {
    for (const Vec3& way : ways) {
        HandPose hand{.molecule = grip_of(world, hand_at(world, 0)).pose};
        hand.molecule->place_angstrom += way;
        const ContactModel felt = contact_at(world, 0).model;
        REQUIRE(step_world(world, hand, felt).finite);
    }
}

double find_farthest(const World& one, const World& other) {
    const std::vector<Vec3>&a = one.resource<AtomTable>().positions,
          &b = other.resource<AtomTable>().positions;
    double farthest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        farthest = std::max(farthest, (a[i] - b[i]).cwiseAbs().maxCoeff());
    return farthest;
}

// The first line that differs in what was saved in two folders; empty: none.
std::string find_difference(const fs::path& one, const fs::path& other) {
    const std::vector<fs::path> files = list_scene_files(one), others = list_scene_files(other);
    for (std::size_t file = 0; file < files.size(); ++file) {
        REQUIRE(fs::exists(files[file]) == fs::exists(others[file]));
        if (!fs::exists(files[file])) continue;
        const std::string text = read_text_file(files[file]), again = read_text_file(others[file]);
        const std::vector<std::string_view> lines = split_lines(text),
                                            lines_again = split_lines(again);
        for (std::size_t i = 0; i < std::min(lines.size(), lines_again.size()); ++i)
            if (lines[i] != lines_again[i]) return fmt::format("{}\n{}", lines[i], lines_again[i]);
        if (text != again) return files[file].string() + " has more lines";
    }
    return {};
}

// Saves a world, opens it, compares it, and saves it again.
World check_saved(const World& world) {
    constexpr double last_digit = 0.6e-10;  // Å, of a coordinate file
    const test::TemporaryFolder first, second;
    const ViewDescription view = world.resource<SceneFile>().scene->view;
    save_scene(world, view, first.path() / "saved.toml", "Saved.", Existing::Refuse);
    World opened = load_world(read_scene(first.path() / "saved.toml", anywhere));
    CHECK(describe_identity(opened) == describe_identity(world));
    CHECK(find_farthest(opened, world) < last_digit);
    const std::vector<Entity> hands = find_hands(world), hands_again = find_hands(opened);
    REQUIRE(hands_again.size() == hands.size());
    for (std::size_t i = 0; i < hands.size(); ++i) {
        if (!world.find<Grip>(hands[i])) continue;
        const Vec3 off = held_place(opened, hands_again[i]) - held_place(world, hands[i]);
        CHECK(off.norm() < 2 * last_digit);
    }
    for (std::size_t i = 0; i < hands.size(); ++i)
        CHECK(coupling_of(opened, hands_again[i]).description ==
              coupling_of(world, hands[i]).description);
    save_scene(opened, view, second.path() / "saved.toml", "Saved.", Existing::Refuse);
    CHECK(find_difference(first.path() / "saved.toml", second.path() / "saved.toml").empty());
    return opened;
}

World load(const std::string& scene, const std::vector<std::string>& settings = {}) {
    return load_world(read_scene(test::in_project("scenes/" + scene), settings));
}

World edited(const World& world, EditAction action, std::size_t hand = 0) {
    return make_edit(world, {0, hand, std::move(action), {}});
}

}  // namespace

TEST_CASE("a saved scene opens where the world was and saves to the same files", "[save]") {
    for (const char* const scene :
         {"water", "water/space.toml", "water/two-hands.toml", "hairpin"}) {
        INFO(scene);
        World world = load(scene);
        check_saved(world);
        pull(world, {{0.2, 0, 0}, {0.1, 0, 0}});
        check_saved(world);
    }
}

TEST_CASE("a saved flexible scene opens where the world was and stays there", "[save]") {
    for (const char* const scene : {"peptide", "hiv/flexible.toml", "hiv/two-hands.toml"}) {
        INFO(scene);
        World world = load(scene);
        pull(world, std::vector<Vec3>(8, {0.1, 0.02, 0}));
        World opened = check_saved(world);
        pull(world, std::vector<Vec3>(10, Vec3::Zero()));
        pull(opened, std::vector<Vec3>(10, Vec3::Zero()));
        const double farthest = find_farthest(opened, world);
        CAPTURE(farthest);
        CHECK(farthest < 0.2);  // of a way of 0.8 Å
    }
}

TEST_CASE("a saved scene has the coupling of each hand", "[save]") {
    World world = load("water/two-hands.toml");
    SceneDescription scene = *world.resource<SceneFile>().scene;
    LiveSettings second = settings_of(scene, 1);
    second.coupling.A_d = 3e7;
    set_coupling(second, scene);
    set_couplings(scene, world);
    check_saved(world);
}

TEST_CASE("a renamed molecule is saved with all that the scene says of it", "[save]") {
    World world = load("hiv/flexible.toml");
    const std::string around = world.resource<MechanicsSettings>().joints.around;
    const World renamed = edited(world, RenameEdit{around, "drug"});
    CHECK(renamed.resource<MechanicsSettings>().joints.around == "drug");
    check_saved(renamed);
}

TEST_CASE("a saved scene has what edits have made", "[save]") {
    World world = load("water/space.toml");
    world = edited(world, AddEdit{"TIP3", "", "a long name of a water", {8, 0, 0}});
    world = edited(world, AddEdit{"", "moved", "copy", {0, 9, 0}});
    world = edited(world, MobilityEdit{"copy", Motion::Free, std::nullopt});
    world = edited(world, AppearanceEdit{"fixed", Representation::Licorice, std::nullopt, false});
    world = edited(world, PinEdit{{"fixed:1 OH2", "moved:1 OH2"}});
    world = edited(world, RestraintEdit{{"copy:1 OH2", "fixed:1"}, std::nullopt, 3, 2});
    world = edited(world, RestraintEdit{{"copy:1 H1"}, std::array{0.1, 9.0, 1.0}, 5, 0});
    check_saved(world);
    world = edited(world, GrabEdit{"copy:1 H2"});
    pull(world, {{0.1, 0.1, 0}, {0.1, 0.1, 0}});
    check_saved(world);
    world = edited(world, GrabEdit{"copy"});
    check_saved(world);
    world = edited(world, RemoveEdit{"moved"});
    check_saved(world);
    world = edited(world, RenameEdit{"fixed", "the first water"});
    check_saved(world);
    world = edited(world, CouplingEdit{{"mode=3"}});
    check_saved(world);
}

TEST_CASE("a saved scene has the hands of the world, full and empty", "[save]") {
    const World along_x = load("water");
    check_saved(edited(along_x, ReleaseEdit{}));
    check_saved(edited(along_x, RemoveEdit{"fixed"}));
    World behind = along_x;
    pull(behind, {{-12, 0, 0}});
    check_saved(behind);
    const World space = edited(load("water/space.toml"), ReleaseEdit{});
    check_saved(space);
    check_saved(edited(space, GrabEdit{"fixed"}));

    const World two = load("water/two-hands.toml");
    check_saved(edited(two, ReleaseEdit{}, 1));
    const World on_one = edited(two, GrabEdit{"left:1 H1"}, 1);
    check_saved(on_one);
    check_saved(edited(on_one, ReleaseEdit{}));
    const World on_line = load("water", {"second.grab.molecule=\"\"", "second.hand.stroke=hold",
                                         "second.grab.measured_from=\"\""});
    check_saved(edited(on_line, GrabEdit{"fixed"}, 1));
}

TEST_CASE("a saved scene forgets views and lessons of molecules that are gone", "[save]") {
    SceneDescription scene = read_scene(test::in_project("scenes/water"));
    scene.view.look_at = "moved";
    scene.view.labels = {"molecule moved", "molecule fixed"};
    scene.view.hidden = {"molecule moved and hydrogen"};
    scene.view.layers = {{Representation::Licorice, "within 3 of molecule moved"}};
    scene.view.marks.measures = {"molecule moved; molecule fixed", "index 1; index 2"};
    scene.view.saved = {{.name = "near", .look_at = "molecule moved", .layers = scene.view.layers}};
    scene.lesson.push_back({"last", "text", "task", LessonQuantity::Way, 1.0, 2.0, 0});
    scene.lesson.back().of = {"molecule moved"};
    const World world = edited(load_world(scene), RemoveEdit{"moved"});
    const World opened = check_saved(world);
    const SceneDescription& kept = *opened.resource<SceneFile>().scene;
    CHECK(kept.view.labels == std::vector<std::string>{"molecule fixed"});
    CHECK(kept.view.marks.measures == std::vector<std::string>{"index 1; index 2"});
    CHECK(kept.view.saved.size() == 1);
    CHECK(kept.lesson.size() + 1 == scene.lesson.size());
}

TEST_CASE("a saved scene keeps the edits of its file that are still to come", "[save]") {
    SceneDescription scene = read_scene(test::in_project("scenes/water"));
    scene.edits = {{0, 0, PinEdit{{"fixed:1 OH2"}}, {}}, {0.01, 0, ReleaseEdit{}, {}}};
    World world = load_world(scene);
    CHECK(describe_world(world, "saved.toml").scene.edits.size() == 2);
    pull(world, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    const std::vector<EditDescription> left = describe_world(world, "saved.toml").scene.edits;
    REQUIRE(left.size() == 1);
    CHECK(left.front().at_s == Approx(0.007));
}

TEST_CASE("saving again replaces the own files and no others", "[save]") {
    const test::TemporaryFolder folder;
    const World world = load("water");
    write_text_file(folder.path() / "water-2.crd", "mine");
    SceneSaver saver(folder.path() / "water.toml", folder.path());
    CHECK(saver.save(world, {}) == folder.path() / "water-3.toml");
    CHECK(saver.save(world, {}) == folder.path() / "water-3.toml");
    CHECK(read_text_file(folder.path() / "water-2.crd") == "mine");
}
