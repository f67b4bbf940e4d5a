// Edits between two steps: what hands take, what is added and removed, and the way back.
#include "loading/edit.h"
#include "session/undo_history.h"

#include "core/files.h"
#include "core/units.h"
#include "field/pair_field.h"
#include "formats/structure.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"
#include "tests/support/step_once.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"
#include "tests/support/world_bytes.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;
using test::world_bytes;

namespace {

World load_two(const std::vector<std::string>& settings = {}) {
    return load_world(read_scene(test::test_data("two_peptides"), settings));
}

World load_waters() { return load_world(test::water_scene({"mode=4"})); }

// Two rigid peptides in space.
World load_rigid() {
    return load_two({"molecules.held.shape=rigid", "molecules.resting.shape=rigid"});
}

EditDescription edit_of(EditAction action) {
    return {0, 0, std::move(action), {"scene.toml", 7, 0}};
}

HandPose hand_after(const Vec3& angstrom) {
    HandPose hand;
    hand.travel_m = angstrom * 0.25e9 * 1e-10;
    return hand;
}

std::string first_molecule(const World& world) {
    std::string name;
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        if (name.empty()) name = molecule.name;
    });
    return name;
}

Vec3 middle_of_residue(const World& world, const std::string& molecule, const std::string& number) {
    const Entity entity = molecule_called(world, molecule);
    return middle_of(world, {entity, atoms_called(world, entity, number)});
}

}  // namespace

TEST_CASE("any molecule can be taken as a whole", "[simulation][edit]") {
    World world = load_rigid();
    const Entity hand = hand_at(world, 0);
    const std::vector<Vec3> before = world.resource<AtomTable>().positions;

    GrabEdit{"resting"}.apply(world, 0);

    CHECK(world.resource<AtomTable>().positions == before);
    CHECK(grip_of(world, hand).molecule == molecule_called(world, "resting"));
    // The force is that of all pairs with the other one.
    const AtomRange own = held_range(world, hand);
    const AtomTable& atoms = world.resource<AtomTable>();
    const AtomRange other{own.first == 0 ? own.count : 0,
                          static_cast<std::uint32_t>(atoms.size()) - own.count};
    const FieldSum field =
        evaluate_pair_field(points_of(atoms, own), points_of(atoms, other), pair_rule(world));
    const Vec3 force = field.force * units::newton_per_kcal_per_mol_angstrom;
    CHECK((contact_at(world, 0).model.force_newton - force).norm() < 1e-12 * force.norm());

    const Vec3 by(0.3, -0.2, 0.1);
    (void)test::step_once(world, hand_after(by), contact_at(world, 0).model);
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 moved = world.resource<AtomTable>().positions[i] - before[i];
        CHECK((moved - (has_atom(own, i) ? by : Vec3(Vec3::Zero()))).norm() < 1e-9);
    }
}

TEST_CASE("any residue or atom can be taken by a spring, in rigid scenes too",
          "[simulation][edit]") {
    const bool is_rigid = GENERATE(true, false);
    const bool is_residue = GENERATE(true, false);
    World world = is_rigid ? load_rigid() : load_two();
    const Entity hand = hand_at(world, 0);
    const std::string name = is_residue ? "3" : "3 CB";
    const Vec3 start = middle_of_residue(world, "resting", name);

    GrabEdit{"resting:" + name}.apply(world, 0);

    CHECK((held_place(world, hand) - start).norm() < 1e-9);
    CHECK(contact_at(world, 0).model.force_newton.norm() < 1e-15);
    ContactModel felt = contact_at(world, 0).model;
    for (int i = 1; i <= 40; ++i) felt = test::step_once(world, hand_after({0, 0.02 * i, 0}), felt);
    const Vec3 now = middle_of_residue(world, "resting", name);
    CHECK((held_place(world, hand) - start - Vec3(0, 0.8, 0)).norm() < 1e-9);
    // It follows, and pulls back by k times the stretch.
    CHECK((now - start).y() > 0.05);
    const Vec3 expected =
        20 * (now - held_place(world, hand)) * units::newton_per_kcal_per_mol_angstrom;
    CHECK((felt.force_newton - expected).norm() < 1e-9 * expected.norm());

    // A hand that lets go gives back what the molecule may do, and feels nothing.
    ReleaseEdit{}.apply(world, 0);
    CHECK(world.find<Grip>(hand) == nullptr);
    CHECK(contact_at(world, 0).model.is_still);
    CHECK(contact_at(world, 0).model.force_newton.norm() == 0);
    if (is_rigid) CHECK_FALSE(has_mobile(world));
    CHECK(step_world(world, hand_after({1, 1, 1}), contact_at(world, 0).model).finite);
    CHECK((middle_of_residue(world, "resting", name) - now).norm() < (is_rigid ? 1e-12 : 1));
}

TEST_CASE("what is in hand goes back to where it was at the start, whatever was done to it",
          "[simulation][edit]") {
    const bool is_rigid = GENERATE(true, false);
    const std::string what = GENERATE("resting", "resting:3 CB");
    World world = is_rigid ? load_rigid() : load_two();
    const std::vector<Vec3> start = world.resource<AtomTable>().positions;
    const Entity hand = hand_at(world, 0);
    GrabEdit{what}.apply(world, 0);
    ContactModel felt = contact_at(world, 0).model;
    for (int i = 1; i <= 40; ++i) felt = test::step_once(world, hand_after({0, 0.05 * i, 0}), felt);
    const AtomRange own = held_range(world, hand);
    const Vec3 others = world.resource<AtomTable>().positions[own.first == 0 ? own.count : 0];
    REQUIRE((world.resource<AtomTable>().positions[own.first] - start[own.first]).norm() > 0.1);
    const std::uint32_t hold = contact_at(world, 0).model.grip_number;

    PutBackEdit{}.apply(world, 0);

    const std::vector<Vec3>& now = world.resource<AtomTable>().positions;
    for (std::uint32_t i = own.first; i < own.first + own.count; ++i)
        CHECK((now[i] - start[i]).norm() < 1e-9);
    CHECK(now[own.first == 0 ? own.count : 0] == others);   // stays where it is
    CHECK(contact_at(world, 0).model.grip_number != hold);  // the servo takes hold anew
    // The hand has it still, without a pull, and leads it from there.
    REQUIRE(world.find<Grip>(hand) != nullptr);
    const bool is_whole = what == "resting";
    if (!is_whole) CHECK(contact_at(world, 0).model.force_newton.norm() < 1e-13);
    const Vec3 place = held_place(world, hand);
    (void)test::step_once(world, hand_after({0.1, 2, 0}), contact_at(world, 0).model);
    CHECK((held_place(world, hand) - place - Vec3(0.1, 0, 0)).norm() < 1e-9);
}

TEST_CASE("nothing goes back onto what is there now, or out of another hand",
          "[simulation][edit]") {
    World world = load_waters();
    const Entity hand = hand_at(world, 0);
    const AtomRange own = held_range(world, hand);
    const Vec3 start = world.resource<AtomTable>().positions[own.first];
    const Vec3 by(8, 0, 0);
    (void)test::step_once(world, hand_after(by), contact_at(world, 0).model);
    AddEdit add{"TIP3", "", "w2", {}};
    std::ranges::copy(start, add.at_angstrom.begin());
    add.apply(world, 0);
    const std::string before = world_bytes(world);

    CHECK_THAT(load_error_of([&] { PutBackEdit{}.apply(world, 0); }),
               Contains("'moved' would overlap") && Contains("room where it was at the start"));

    CHECK(world_bytes(world) == before);
    ReleaseEdit{}.apply(world, 0);
    CHECK_THAT(load_error_of([&] { PutBackEdit{}.apply(world, 0); }),
               Contains("the hand holds nothing"));
}

TEST_CASE("after adding and removing a molecule the world is what it was, to the byte",
          "[simulation][edit][slow]") {
    struct Row {
        std::string file;
        std::vector<std::string> settings;
        std::string residue, copy_of;
        std::filesystem::path structure{}, topology{};
        std::string segment{};
    };
    const std::string waters = test::in_project("scenes/water/"),
                      hiv = test::in_project("scenes/hiv/"),
                      peptides = test::test_data("two_peptides");
    const auto row = GENERATE_COPY(values<Row>({
        {waters + "scene.toml", {"mode=4"}, "TIP3", ""},
        {waters + "space.toml", {}, "", "moved"},
        {waters + "two-hands.toml", {}, "TIP3", ""},
        {waters + "two-hands.toml",
         {"molecules.left.motion=translate-and-turn", "molecules.right.motion=translate-and-turn"},
         "",
         "right"},
        {peptides, {}, "", "resting"},
        {peptides, {"statics.active=4"}, "", "held"},
        {peptides, {"molecules.held.shape=rigid", "molecules.resting.shape=rigid"}, "", "held"},
        {peptides, {"grab.atom=3 CB", "molecules.held.motion=free"}, "", "held"},
        {waters + "scene.toml", {"mode=4"}, "", "", waters + "three.crd", "", "LEFT"},
        {waters + "two-hands.toml", {}, "", "", waters + "dimer.crd", "", "MOV"},
        {peptides, {}, "", "", peptides + "/both.crd", peptides + "/both.psf", "PEPA"},
        {peptides,
         {"statics.active=4"},
         "",
         "",
         peptides + "/both.crd",
         peptides + "/both.psf",
         "PEPB"},
        {hiv + "scene.toml", {}, "", "inhibitor"},
        {hiv + "scene.toml", {}, "", "", hiv + "relaxed.crd", hiv + "system.psf", "TL3C"},
        {hiv + "flexible.toml", {}, "", "inhibitor"},
        {hiv + "two-hands.toml", {}, "", "protease_b"},
    }));
    INFO(row.file << " with a copy of '" << row.copy_of << "' or " << row.structure);
    World world = load_world(read_scene(row.file, row.settings));
    (void)test::step_once(world, hand_after({-0.2, 0, 0}), contact_at(world, 0).model);
    // An edit of what moves begins mechanics anew, from where everything is.
    MobilityEdit{first_molecule(world), {}, {}}.apply(world, 0);
    const std::string before = world_bytes(world);
    World never = world;
    const std::size_t atoms = world.resource<AtomTable>().size();
    const AddEdit add{row.residue,   row.copy_of,  "another",  {90, 80, 70},
                      row.structure, row.topology, row.segment};

    add.apply(world, 0);

    const Molecule& added = *world.find<Molecule>(molecule_called(world, "another"));
    CHECK(world.resource<AtomTable>().size() == atoms + added.atoms.count);
    if (!row.copy_of.empty()) {
        const Entity original = molecule_called(world, row.copy_of);
        CHECK(added.atoms.count == world.find<Molecule>(original)->atoms.count);
    }
    CHECK((world.resource<AtomTable>().positions[added.reference_atom] - Vec3(90, 80, 70)).norm() <
          1e-12);
    CHECK((world_bytes(world) != before));
    RemoveEdit{"another"}.apply(world, 0);
    REQUIRE((world_bytes(world) == before));
    // And does the same from then on.
    for (World* const each : {&world, &never}) {
        for (int i = 0; i < 3; ++i)
            (void)test::step_once(*each, hand_after({-0.3, 0.1 * i, 0}),
                                  contact_at(*each, 0).model);
    }
    CHECK((world_bytes(world) == world_bytes(never)));
}

TEST_CASE("a water that is added has the shape of its parameters", "[simulation][edit]") {
    World world = load_waters();
    AddEdit{"TIP3", "", "w2", {0, 10, 0}}.apply(world, 0);
    const AtomTable& atoms = world.resource<AtomTable>();
    const AtomRange range = world.find<Molecule>(molecule_called(world, "w2"))->atoms;
    const Vec3 o = atoms.positions[range.first];
    const Vec3 h1 = atoms.positions[range.first + 1] - o, h2 = atoms.positions[range.first + 2] - o;
    CHECK(atoms.names[range.first].atom == "OH2");
    CHECK(h1.norm() == Approx(0.9572));
    CHECK(h2.norm() == Approx(0.9572));
    CHECK(std::acos(h1.normalized().dot(h2.normalized())) * 180 / 3.14159265358979 ==
          Approx(104.52));
    // It is felt: the force is the sum of two waters'.
    const Entity hand = hand_at(world, 0);
    Vec3 sum = Vec3::Zero();
    for (const char* const name : {"fixed", "w2"}) {
        const AtomRange other = world.find<Molecule>(molecule_called(world, name))->atoms;
        sum +=
            evaluate_pair_field(held_points(world, hand), points_of(atoms, other), pair_rule(world))
                .force;
    }
    CHECK((field_on_held(world, hand).force - sum).norm() < 1e-12 * sum.norm());
}

TEST_CASE("what is added from files is what a scene with that molecule has", "[simulation][edit]") {
    const bool is_flexible = GENERATE(false, true);
    const std::string peptides = test::test_data("two_peptides");
    const std::string file = peptides + "/both.crd", psf = peptides + "/both.psf";
    std::vector<std::string> settings;
    if (!is_flexible) settings = {"molecules.held.shape=rigid", "molecules.resting.shape=rigid"};
    World world = load_two(settings);
    const Entity held = molecule_called(world, "held"), resting = molecule_called(world, "resting");
    const std::vector<AtomName> names = world.resource<AtomTable>().names;
    // Another one of the same files in the place of what was there.
    const Vec3 at =
        world.resource<AtomTable>().positions[world.find<Molecule>(resting)->atoms.first];
    RemoveEdit{"resting"}.apply(world, 0);

    AddEdit{"", "", "again", {at.x(), at.y(), at.z()}, file, psf, "PEPA"}.apply(world, 0);

    World whole = load_two(settings);
    const AtomTable &now = world.resource<AtomTable>(), &then = whole.resource<AtomTable>();
    REQUIRE(now.size() == then.size());
    const AtomRange added = world.find<Molecule>(molecule_called(world, "again"))->atoms;
    const AtomRange known = whole.find<Molecule>(molecule_called(whole, "resting"))->atoms;
    const Structure in_file = read_structure(file);
    const Vec3 first = in_file.positions[0];
    for (std::uint32_t i = 0; i < added.count; ++i) {
        const std::uint32_t a = added.first + i, b = known.first + i;
        CHECK(now.names[a].segment == "again");
        CHECK(now.names[a].atom == then.names[b].atom);
        CHECK(now.names[a].number == then.names[b].number);
        CHECK(now.charge[a] == Approx(then.charge[b]));
        CHECK(now.mass[a] == Approx(then.mass[b]));
        CHECK(now.type_names[now.type[a]] == then.type_names[then.type[b]]);
        CHECK((now.positions[a] - at - (in_file.positions[i] - first)).norm() < 1e-12);
    }
    CHECK(now.bonds.size() == then.bonds.size());
    if (is_flexible) {
        CHECK(world.resource<BondedTerms>().topology->bonds.size() ==
              whole.resource<BondedTerms>().topology->bonds.size());
        CHECK(world.resource<BondedTerms>().topology->dihedrals.size() ==
              whole.resource<BondedTerms>().topology->dihedrals.size());
    }
    // What is in hand feels it.
    CHECK(grip_of(world, hand_at(world, 0)).molecule == held);
    const Vec3 force = evaluate_pair_field(held_points(world, hand_at(world, 0)),
                                           points_of(now, added), pair_rule(world))
                           .force;
    CHECK((field_on_held(world, hand_at(world, 0)).force - force).norm() < 1e-12 * force.norm());
}

TEST_CASE("what files lack is refused by name, and nothing changes", "[simulation][edit][errors]") {
    const auto atom = [](int i, const std::string& residue, const std::string& name) {
        return fmt::format(
            "{:10}{:10}  {:8}  {:8}{:20.10f}{:20.10f}{:20.10f}  {:8}  {:8}{:20.10f}\n", i, 1,
            residue, name, 1.0 * i, 0.0, 50.0, "ONE", 1, 0.0);
    };
    const std::string two = atom(1, "TIP3", "OH2") + atom(2, "TIP3", "H1");
    const std::string water = two + atom(3, "TIP3", "H2");
    const auto crd = [](const std::string& atoms) {
        return fmt::format("* A test\n*\n{:10}  EXT\n{}", std::ranges::count(atoms, '\n'), atoms);
    };
    const test::TemporaryFolder folder;
    folder.add_file("whole.crd", crd(water));
    folder.add_file("other.txt", crd(water));
    folder.add_file("unknown.crd", crd(atom(1, "XYZ", "A")));
    folder.add_file("lacks.crd", crd(two));
    folder.add_file("more.crd", crd(water + atom(4, "TIP3", "H9")));
    folder.add_file("three.crd", read_text_file(test::in_project("scenes/water/three.crd")));
    folder.add_file("both.psf", read_text_file(test::test_data("two_peptides/both.psf")));
    struct Row {
        std::string structure, topology, segment;
        std::vector<std::string> what;
    };
    const auto row = GENERATE(values<Row>({
        {"no.crd", "", "", {"no.crd"}},
        {"other.txt", "", "", {"other.txt", ".crd"}},
        {"three.crd",
         "",
         "",
         {"three.crd: has 3 segments, and none is named; expected segment to be one of 'FIX', "
          "'LEFT', 'RIGH'"}},
        {"whole.crd", "", "TWO", {"whole.crd: has no segment 'TWO'; expected one of 'ONE'"}},
        {"whole.crd", "both.psf", "", {"both.psf: has no segment 'ONE', which ", "'PEPA', 'PEPB'"}},
        {"unknown.crd", "", "", {"unknown.crd:4: ", "'XYZ'"}},
        {"lacks.crd", "", "", {"lacks.crd:4: residue new TIP3 1 lacks atom 'H2'"}},
        {"more.crd", "", "", {"more.crd:7: ", "has no atom 'H9'"}},
    }));
    INFO(row.structure << " " << row.segment);
    const auto in_folder = [&](const std::string& name) {
        return name.empty() ? std::filesystem::path() : folder.path() / name;
    };
    World world = load_waters();
    const std::string before = world_bytes(world);
    UndoHistory history;
    const AddEdit add{
        "", "", "new", {0, 0, 50}, in_folder(row.structure), in_folder(row.topology), row.segment};

    const std::string error = load_error_of([&] { history.apply(world, edit_of(add)); });

    for (const std::string& what : row.what) CHECK_THAT(error, Contains(what));
    CHECK(world_bytes(world) == before);
    CHECK(history.undo_name().empty());
    AddEdit{"", "", "new", {0, 0, 50}, in_folder("whole.crd")}.apply(world, 0);
    CHECK(world.resource<AtomTable>().size() == 9);
}

TEST_CASE("what a residue's parameters lack is refused by name", "[simulation][edit][errors]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path scene = folder.path() / "water";
    std::filesystem::copy(test::in_project("scenes/water"), scene);
    // Type XX has no mass; the bond of two oxygens no parameters.
    std::string more =
        "* More\n*\nread rtf card append\n* More\n*\n36 1\n"
        "RESI BAD 0.0\nATOM A XX 0.0\n"
        "RESI OXY 0.0\nATOM O1 OT 0.0\nATOM O2 OT 0.0\nBOND O1 O2\nEND\n";
    std::ofstream(scene / "more.str") << more;
    World world = load_world(read_scene(
        scene, std::vector<std::string>{"force_field.files=[\"tip3p.str\", \"more.str\"]"}));
    const std::string before = world_bytes(world);

    CHECK_THAT(load_error_of([&] { AddEdit{"BAD", "", "new", {0, 9, 0}}.apply(world, 0); }),
               Contains("'XX'"));
    CHECK_THAT(load_error_of([&] { AddEdit{"OXY", "", "new", {0, 9, 0}}.apply(world, 0); }),
               Contains("bond") && Contains("OT"));
    CHECK(world_bytes(world) == before);
}

TEST_CASE("an edit that cannot be made leaves everything as it was, and says why",
          "[simulation][edit][errors]") {
    struct Row {
        EditAction action;
        const char* what;
    };
    const auto row = GENERATE(values<Row>({
        {GrabEdit{"nobody"}, "there is no molecule 'nobody'; there are resting, held"},
        {GrabEdit{"held:99"}, "'held' has no residue or atom \"99\""},
        {AddEdit{"XYZ", "", "new", {}}, "no residue 'XYZ'"},
        {AddEdit{"", "held", "resting", {}}, "there is already a molecule 'resting'"},
        {AddEdit{"", "held", "a:b", {}}, "'a:b' is not a name of a molecule"},
        {AddEdit{"", "held", "", {}}, "has no name"},
        {RemoveEdit{"nobody"}, "there is no molecule 'nobody'"},
        {PinEdit{{"held"}}, "is a whole molecule; expected a residue or atom of it"},
        {RestraintEdit{{"held:2 CA"}, {}, 20, 0}, "between two atoms or residues"},
        {MobilityEdit{"held", Motion::Translate, {}},
         "this motion needs a hand that holds the molecule"},
        {CouplingEdit{{"mode=9"}}, "mode"},
        {UndoEdit{}, "there is nothing to undo"},
    }));
    World world = load_two();
    const std::string before = world_bytes(world);
    UndoHistory history;

    const std::string error = load_error_of([&] { history.apply(world, edit_of(row.action)); });

    CHECK_THAT(error, Catch::StartsWith("scene.toml:7: ") && Contains(row.what));
    CHECK(world_bytes(world) == before);
    CHECK(history.undo_name().empty());
}

TEST_CASE("undo and redo lead back through random edits and moves, to the byte",
          "[simulation][edit]") {
    const bool is_mobile = GENERATE(false, true);
    const unsigned seed = GENERATE(range(0U, 25U));
    std::mt19937 random(seed);
    World world = is_mobile ? load_two() : load_waters();
    const std::string first = is_mobile ? "resting" : "fixed",
                      second = is_mobile ? "held" : "moved";
    UndoHistory history;
    std::vector<std::string> states;  // before each entry
    const auto draw = [&](unsigned n) { return random() % n; };
    const auto move = [&] {
        (void)test::step_once(world, hand_after({0.01 * draw(10), 0.01 * draw(10), 0}),
                              contact_at(world, 0).model);
    };
    const auto any_edit = [&]() -> EditAction {
        const std::string who = draw(2) == 0 ? first : second;
        switch (draw(6)) {
            case 0:
                return GrabEdit{who};
            case 1:
                return GrabEdit{who + (is_mobile ? ":2 CA" : ":1")};
            case 2:
                return AddEdit{"",
                               who,
                               "copy" + std::to_string(states.size()),
                               {30.0 + draw(5), 20.0 * states.size(), 0}};
            case 3:
                return PinEdit{{first + ":1", second + ":1"}};
            case 4:
                return CouplingEdit{{draw(2) == 0 ? "mode=3" : "mode=guarded"}};
            default:
                return MobilityEdit{who, draw(2) == 0 ? Motion::Free : Motion::Fixed, {}};
        }
    };
    for (int i = 0; i < 8; ++i) {
        const std::string before = world_bytes(world);
        history.apply(world, edit_of(any_edit()));
        states.push_back(before);
        for (unsigned steps = draw(3); steps > 0; --steps) move();
    }
    states.push_back(world_bytes(world));
    for (std::size_t i = states.size() - 1; i > 0; --i) {
        history.apply(world, edit_of(UndoEdit{}));
        REQUIRE(world_bytes(world) == states[i - 1]);
    }
    CHECK(history.undo_name().empty());
    for (std::size_t i = 1; i < states.size(); ++i) {
        history.apply(world, edit_of(RedoEdit{}));
    }
    CHECK(world_bytes(world) == states.back());
    CHECK(history.redo_name().empty());
}

TEST_CASE("nothing is added on top of what is there, and the message says where that is",
          "[simulation][edit][errors]") {
    World world = load_waters();
    const std::string before = world_bytes(world);
    const AtomTable& atoms = world.resource<AtomTable>();
    const AtomRange fixed = world.find<Molecule>(molecule_called(world, "fixed"))->atoms;
    // 0.8 Å from the oxygen; hydrogens may be nearer to something.
    const Vec3 place = atoms.positions[fixed.first] + Vec3(0, 0, 0.8);
    AddEdit add{"", "fixed", "copy", {place.x(), place.y(), place.z()}};
    double nearest = 100;
    std::string one, other;
    for (std::uint32_t i = 0; i < 3; ++i) {
        const Vec3 moved = place + atoms.positions[fixed.first + i] - atoms.positions[fixed.first];
        for (std::uint32_t j = 0; j < atoms.size(); ++j) {
            if ((moved - atoms.positions[j]).norm() >= nearest) continue;
            nearest = (moved - atoms.positions[j]).norm();
            one = atoms.names[fixed.first + i].atom;
            other = to_string(atoms.names[j]);
        }
    }

    const std::string error = load_error_of([&] { add.apply(world, 0); });

    CHECK_THAT(error, Contains("'copy' would overlap another molecule") &&
                          Contains(fmt::format("copy TIP3 1 {} is {:.2f} Å from {}", one, nearest,
                                               other)) &&
                          Contains("expected a place (at_angstrom) with at least 1 Å"));
    CHECK(world_bytes(world) == before);
    add.at_angstrom[2] += 6;
    add.apply(world, 0);
    CHECK(world.resource<AtomTable>().size() == 9);
}

TEST_CASE("undo takes back a grip from taking hold to letting go", "[simulation][edit]") {
    World world = load_rigid();
    UndoHistory history;
    const std::string before = world_bytes(world);
    history.apply(world, edit_of(GrabEdit{"resting:2"}));
    for (int i = 1; i <= 5; ++i)
        (void)test::step_once(world, hand_after({0, 0.1 * i, 0}), contact_at(world, 0).model);
    history.apply(world, edit_of(ReleaseEdit{}));
    const std::string after = world_bytes(world);

    history.apply(world, edit_of(UndoEdit{}));
    CHECK(world_bytes(world) == before);
    // The hand stays where its device is: what it holds stays where it is.
    const Vec3 place = held_place(world, hand_at(world, 0));
    (void)test::step_once(world, hand_after({0, 0.5, 0}), contact_at(world, 0).model);
    CHECK((held_place(world, hand_at(world, 0)) - place).norm() < 1e-12);
    history.apply(world, edit_of(RedoEdit{}));
    CHECK(world_bytes(world) == after);
}

TEST_CASE("what a scene began with is let go, and that is undone", "[simulation][edit]") {
    World world = load_rigid();
    UndoHistory history;
    const std::string before = world_bytes(world);
    history.apply(world, edit_of(ReleaseEdit{}));
    CHECK(world.find<Grip>(hand_at(world, 0)) == nullptr);
    history.apply(world, edit_of(UndoEdit{}));
    CHECK(world_bytes(world) == before);

    // What was undone is gone once anything else is done.
    history.apply(world, edit_of(GrabEdit{"resting:2"}));
    history.apply(world, edit_of(UndoEdit{}));
    history.apply(world, edit_of(ReleaseEdit{}));
    CHECK(history.redo_name().empty());
}

TEST_CASE("two hands at one molecule leave it as it was, whichever lets go first",
          "[simulation][edit]") {
    World world = load_world(read_scene(test::in_project("scenes/water/two-hands.toml")));
    const std::vector<Entity> hands = find_hands(world);
    ReleaseEdit{}.apply(world, 0);
    ReleaseEdit{}.apply(world, 1);
    const Entity molecule = molecule_called(world, "standing");
    const Mobility own = *world.find<Mobility>(molecule);
    const std::size_t first = GENERATE(0, 1);
    const bool is_whole = GENERATE(false, true);
    GrabEdit{is_whole ? "standing" : "standing:1"}.apply(world, 0);
    GrabEdit{"standing:1"}.apply(world, 1);
    ReleaseEdit{}.apply(world, first);
    ReleaseEdit{}.apply(world, 1 - first);
    CHECK(world.find<Mobility>(molecule)->motion == own.motion);
    CHECK(world.find<Mobility>(molecule)->shape == own.shape);
}

TEST_CASE("a coupling whose law cannot be built is refused", "[simulation][edit]") {
    World world = load_waters();
    const std::string before = world_bytes(world);
    CHECK_THAT(load_error_of([&] {
                   CouplingEdit{{"mode=guarded", "force_law=calibrated", "F_0_nN=0.0"}}.apply(world,
                                                                                              0);
               }),
               Contains("cannot have the slopes"));
    CHECK(world_bytes(world) == before);
}

TEST_CASE("a reset is the scene as its file has it, and can be undone", "[simulation][edit]") {
    const bool is_mobile = GENERATE(false, true);
    World world = is_mobile ? load_two() : load_waters();
    const std::string name = is_mobile ? "resting" : "fixed";
    const std::string start = world_bytes(world);
    const CouplingMode mode = coupling_of(world, hand_at(world, 0)).description.mode;
    UndoHistory history;
    history.apply(world, edit_of(AddEdit{"", name, "another", {30, 0, 0}}));
    history.apply(world, edit_of(GrabEdit{"another"}));
    history.apply(world, edit_of(CouplingEdit{{"mode=3"}}));
    (void)test::step_once(world, hand_after({0.3, 0.2, 0}), contact_at(world, 0).model);
    const std::string changed = world_bytes(world);
    const std::uint32_t last = contact_at(world, 0).model.grip_number;

    history.apply(world, edit_of(ResetEdit{}));

    CHECK(world_bytes(world) == start);
    CHECK(coupling_of(world, hand_at(world, 0)).description.mode == mode);
    // Time goes on, and the hand, which takes hold anew where its device is.
    CHECK(world.resource<Clock>().steps == 1);
    CHECK(contact_at(world, 0).model.grip_number > last);
    const Vec3 place = held_place(world, hand_at(world, 0));
    (void)test::step_once(world, hand_after({0.3, 0.2, 0}), contact_at(world, 0).model);
    CHECK((held_place(world, hand_at(world, 0)) - place).norm() < 1e-12);
    history.apply(world, edit_of(UndoEdit{}));
    CHECK(world_bytes(world) == changed);
    history.apply(world, edit_of(RedoEdit{}));
    history.apply(world, edit_of(UndoEdit{}));
    CHECK(world_bytes(world) == changed);
}

TEST_CASE("a reset to files that are gone leaves everything as it was",
          "[simulation][edit][errors]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path copy = folder.path() / "water";
    std::filesystem::copy(test::in_project("scenes/water"), copy);
    World world = load_world(read_scene(copy));
    UndoHistory history;
    history.apply(world, edit_of(GrabEdit{"fixed"}));
    const std::string before = world_bytes(world);
    std::filesystem::remove(copy / "dimer.crd");

    CHECK_THAT(load_error_of([&] { history.apply(world, edit_of(ResetEdit{})); }),
               Catch::StartsWith("scene.toml:7: ") && Contains("dimer.crd"));

    CHECK(world_bytes(world) == before);
}

TEST_CASE("only so many entries are kept, and the oldest go first", "[simulation][edit]") {
    World world = load_waters();
    UndoHistory history;
    for (std::size_t i = 0; i < UndoHistory::most_entries + 5; ++i)
        history.apply(world, edit_of(AppearanceEdit{"fixed", {}, {}, i % 2 == 0}));
    CHECK(history.dropped() == 5);
    std::size_t undone = 0;
    for (; !history.undo_name().empty(); ++undone) history.apply(world, edit_of(UndoEdit{}));
    CHECK(undone == UndoHistory::most_entries);
}

TEST_CASE(
    "a handle turns what it holds beside what moves by itself too, and a failed step turns it "
    "back",
    "[simulation][edit]") {
    World world = load_world(read_scene(test::in_project("scenes/water/space.toml")));
    const bool is_adaptive = GENERATE(false, true);
    world.write<MechanicsSettings>().statics.method =
        is_adaptive ? RelaxMethod::QuasiStatic : RelaxMethod::SecondOrder;
    const Entity hand = hand_at(world, 0);
    MobilityEdit{"fixed", Motion::Free, {}}.apply(world, 0);
    REQUIRE(grip_of(world, hand).freedom == 6);
    REQUIRE(grip_of(world, hand).base >= 0);
    REQUIRE((find_solver<PaperStep>(world) != nullptr) == is_adaptive);
    const AtomRange held = held_range(world, hand);
    const std::vector<Vec3> before = world.resource<AtomTable>().positions;
    const MoleculePose start = grip_of(world, hand).pose;
    HandPose pose;
    pose.molecule = start;
    pose.molecule->place_angstrom += Vec3(0.2, -0.1, 0.3);
    const Quat turn(Eigen::AngleAxisd(0.4, Vec3(1, 2, -1).normalized()));
    pose.molecule->orientation = turn * start.orientation;
    pose.grip_number = contact_at(world, 0).model.grip_number;

    REQUIRE(step_world(world, pose, contact_at(world, 0).model).finite);

    const auto is_turned = [&] {
        const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
        for (std::uint32_t i = 0; i < held.count; ++i) {
            const Vec3 expected = before[held.first] + Vec3(0.2, -0.1, 0.3) +
                                  turn * (before[held.first + i] - before[held.first]);
            if ((positions[held.first + i] - expected).norm() > 1e-9) return false;
        }
        return true;
    };
    CHECK(is_turned());

    const MoleculePose kept = grip_of(world, hand).pose;
    const TorsionState state = world.resource<TorsionState>();
    world.set(world.create(), Spring{.ends = {{grip_of(world, hand).molecule, {0}}},
                                     .k = std::numeric_limits<double>::quiet_NaN()});
    pose.molecule->place_angstrom += Vec3(0.5, 0.7, 0.1);
    pose.molecule->orientation = turn * pose.molecule->orientation;
    CHECK_FALSE(step_world(world, pose, contact_at(world, 0).model).finite);
    CHECK(grip_of(world, hand).pose.place_angstrom == kept.place_angstrom);
    CHECK(grip_of(world, hand).pose.orientation.coeffs() == kept.orientation.coeffs());
    CHECK(world.resource<TorsionState>()
              .turns[static_cast<std::size_t>(grip_of(world, hand).base)]
              .coeffs() ==
          state.turns[static_cast<std::size_t>(grip_of(world, hand).base)].coeffs());
    CHECK(world.resource<TorsionState>().shifts == state.shifts);
    CHECK(is_turned());
}

TEST_CASE("a rigid molecule keeps its orientation from one grip to the next",
          "[simulation][edit]") {
    World world = load_world(read_scene(test::in_project("scenes/water/space.toml")));
    const Entity hand = hand_at(world, 0);
    const std::string name = world.find<Molecule>(grip_of(world, hand).molecule)->name;
    REQUIRE(grip_of(world, hand).freedom == 6);
    HandPose pose;
    pose.molecule = grip_of(world, hand).pose;
    pose.molecule->orientation = Quat(Eigen::AngleAxisd(0.4, Vec3(1, 2, -1).normalized()));
    pose.grip_number = contact_at(world, 0).model.grip_number;
    REQUIRE(step_world(world, pose, contact_at(world, 0).model).finite);
    const Quat turned = pose.molecule->orientation;
    const std::vector<Vec3> before = world.resource<AtomTable>().positions;

    ReleaseEdit{}.apply(world, 0);
    GrabEdit{name}.apply(world, 0);

    CHECK(grip_of(world, hand).pose.orientation.angularDistance(turned) < 1e-12);
    pose.molecule = grip_of(world, hand).pose;
    pose.grip_number = contact_at(world, 0).model.grip_number;
    REQUIRE(step_world(world, pose, contact_at(world, 0).model).finite);
    const std::vector<Vec3>& after = world.resource<AtomTable>().positions;
    for (std::size_t i = 0; i < after.size(); ++i) CHECK((after[i] - before[i]).norm() < 1e-9);

    // From the start again it is as loaded.
    PutBackEdit{}.apply(world, 0);
    CHECK(grip_of(world, hand).pose.orientation.angularDistance(Quat::Identity()) < 1e-12);
    ReleaseEdit{}.apply(world, 0);
    GrabEdit{name}.apply(world, 0);
    CHECK(grip_of(world, hand).pose.orientation.angularDistance(Quat::Identity()) < 1e-12);
}

TEST_CASE("a molecule that a hand turned at a spring has that orientation in the next grip",
          "[simulation][edit]") {
    World world = load_world(read_scene(test::in_project("scenes/water/space.toml")));
    const Entity hand = hand_at(world, 0);
    const Entity water = grip_of(world, hand).molecule;
    const Molecule molecule = *world.find<Molecule>(water);
    const auto arm_of = [&](std::uint32_t atom) {
        const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
        return Vec3(positions[molecule.atoms.first + atom] - positions[molecule.reference_atom]);
    };
    const Vec3 before = arm_of(1), other_before = arm_of(2);
    GrabEdit{molecule.name + ":1 H1"}.apply(world, 0);
    ContactModel felt = contact_at(world, 0).model;
    for (int i = 1; i <= 40; ++i) felt = test::step_once(world, hand_after({0, 0.1 * i, 0}), felt);
    REQUIRE((arm_of(1) - before).norm() > 0.2);

    ReleaseEdit{}.apply(world, 0);
    GrabEdit{molecule.name}.apply(world, 0);

    const Quat turned = grip_of(world, hand).pose.orientation;
    CHECK((turned * before - arm_of(1)).norm() < 1e-9);
    CHECK((turned * other_before - arm_of(2)).norm() < 1e-9);
}

TEST_CASE("a molecule held from the start stays in hand when nothing else is mobile any more",
          "[simulation][edit]") {
    World world = load_two({"molecules.held.shape=rigid", "molecules.resting.shape=rigid",
                            "molecules.resting.motion=free", "grab.measured_from=\"\""});
    const Entity hand = hand_at(world, 0);
    REQUIRE(grip_of(world, hand).base >= 0);
    const Vec3 held = held_place(world, hand);
    MobilityEdit{"resting", Motion::Fixed, {}}.apply(world, 0);
    REQUIRE(grip_of(world, hand).base < 0);

    const std::vector<Vec3> before = world.resource<AtomTable>().positions;
    (void)test::step_once(world, hand_after({0.3, 0, 0}), contact_at(world, 0).model);
    const Vec3 way = held_place(world, hand) - held;
    CHECK(way.norm() > 0.1);
    const AtomRange range = held_range(world, hand);
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
        CHECK((world.resource<AtomTable>().positions[i] - before[i] - way).norm() < 1e-12);
}

TEST_CASE("a restraint pulls at both ends, and marks measure", "[simulation][edit]") {
    World world = load_two();
    const Vec3 apart =
        middle_of_residue(world, "held", "2 CA") - middle_of_residue(world, "resting", "2 CA");
    PinEdit{{"resting:2 CA", "held:2 CA"}}.apply(world, 0);
    RestraintEdit{{"held:2 CA", "resting:2 CA"}, {}, 50, apart.norm() - 1}.apply(world, 0);
    ContactModel felt = contact_at(world, 0).model;
    for (int i = 0; i < 60; ++i) felt = test::step_once(world, {}, felt);
    double distance = 0;
    world.each<Mark>([&](Entity, const Mark& mark) { distance = mark.value; });
    const Vec3 now =
        middle_of_residue(world, "held", "2 CA") - middle_of_residue(world, "resting", "2 CA");
    CHECK(distance == Approx(now.norm()));
    CHECK(distance < apart.norm() - 0.2);
}

TEST_CASE("another spring of the same ends takes the first one's place, k = 0 removes it",
          "[simulation][edit]") {
    World world = load_two();
    const std::vector<std::string> ends{"held:2 CA", "resting:2 CA"};
    const auto list = [&] {
        std::vector<double> ks;
        world.each<Spring>([&](Entity, const Spring& spring) { ks.push_back(spring.k); });
        return ks;
    };
    RestraintEdit{ends, {}, 50, 1}.apply(world, 0);
    RestraintEdit{{"resting:3 CA"}, {{0, 0, 0}}, 7, 1}.apply(world, 0);
    RestraintEdit{ends, {}, 30, 1}.apply(world, 0);
    CHECK(list() == std::vector<double>{30, 7});
    RestraintEdit{ends, {}, 0, 1}.apply(world, 0);
    CHECK(list() == std::vector<double>{7});
    CHECK_THAT(load_error_of([&] { RestraintEdit{ends, {}, 0, 1}.apply(world, 0); }),
               Contains("no spring at held:2 CA and resting:2 CA"));
}

TEST_CASE("a mark of the same atoms removes the first one", "[simulation][edit]") {
    World world = load_waters();
    const PinEdit mark{{"fixed:1 OH2", "moved:1 OH2"}};
    const auto count = [&] {
        int marks = 0;
        world.each<Mark>([&](Entity, const Mark&) { ++marks; });
        return marks;
    };
    mark.apply(world, 0);
    PinEdit{{"fixed:1 OH2"}}.apply(world, 0);
    CHECK(count() == 2);
    mark.apply(world, 0);
    CHECK(count() == 1);
    world.each<Mark>([&](Entity, const Mark& left) { CHECK(left.atoms.size() == 1); });
}

TEST_CASE("relaxing brings to rest what no hand holds", "[simulation][edit]") {
    World world = load_two();
    const Entity hand = hand_at(world, 0);
    ContactModel felt = contact_at(world, 0).model;
    for (int i = 1; i <= 20; ++i) felt = test::step_once(world, hand_after({0.05 * i, 0, 0}), felt);
    const auto energy = [&] { return contact_at(world, 0).model.potential_kcal_per_mol; };
    const Vec3 place = held_place(world, hand);
    const double pulled = energy();

    RelaxEdit{}.apply(world, 0);

    const double rest = energy();
    CHECK(rest < pulled - 0.01);
    CHECK((held_place(world, hand) - place).norm() < 1e-9);
    // Nothing is left to do: steps go nowhere, and neither does another relaxation.
    const std::vector<Vec3> before = world.resource<AtomTable>().positions;
    felt = contact_at(world, 0).model;
    for (int i = 0; i < 20; ++i) felt = test::step_once(world, hand_after({1, 0, 0}), felt);
    RelaxEdit{}.apply(world, 0);
    CHECK(energy() == Approx(rest).margin(1e-3));
    double farthest = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        farthest =
            std::max(farthest, (world.resource<AtomTable>().positions[i] - before[i]).norm());
    CHECK(farthest < 0.02);
}

TEST_CASE("where only hands move something, nothing can relax", "[simulation][edit]") {
    World world = load_waters();
    CHECK_THAT(load_error_of([&] { RelaxEdit{}.apply(world, 0); }),
               Contains("nothing here moves by itself"));
}

TEST_CASE("a molecule has the name that it was given last, and no other one's",
          "[simulation][edit]") {
    World world = load_two();
    const Entity molecule = molecule_called(world, "resting");
    RenameEdit{"resting", "ligand"}.apply(world, 0);
    CHECK(molecule_called(world, "ligand") == molecule);
    CHECK(molecule_called(world, "resting") == Entity{});
    GrabEdit{"ligand:3 CB"}.apply(world, 0);
    RenameEdit{"ligand", "ligand"}.apply(world, 0);
    CHECK_THAT(load_error_of([&] { RenameEdit{"ligand", "held"}.apply(world, 0); }),
               Contains("there is already a molecule 'held'"));
    CHECK_THAT(load_error_of([&] { RenameEdit{"ligand", "a:1"}.apply(world, 0); }),
               Contains("'a:1' is not a name of a molecule"));
    // A hand measures from it still.
    int measured = 0;
    world.each<GripSettings>([&](Entity, const GripSettings& settings) {
        measured += settings.measured_from == "ligand" ? 1 : 0;
    });
    CHECK(measured == 1);
    CHECK_THAT(load_error_of([&] { RenameEdit{"resting", "other"}.apply(world, 0); }),
               Contains("resting"));
}
