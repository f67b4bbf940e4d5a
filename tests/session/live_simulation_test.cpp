// Edits that take longer than a step: made beside the steps, adopted between two.
#include "session/live_simulation.h"

#include "haptics/device.h"
#include "scene/read_scene.h"
#include "session/undo_history.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <string>
#include <thread>
#include <vector>

using namespace palpa;
using Catch::Contains;

namespace {

class NoServo final : public ServoLine {
public:
    void post(std::size_t /*slot*/, const LocalContactModel& /*touch*/,
              std::uint64_t /*number*/) override {}
    void post(std::size_t /*slot*/, const ServoOrder& /*order*/) override {}
};

DeviceSpec omni_spec() {
    DeviceSpec spec;
    spec.name = "omni";
    spec.peak_force_newton = 3.3;
    spec.half_workspace_m = {0.08, 0.06, 0.035};
    return spec;
}

struct Live {
    explicit Live(const char* scene, std::size_t hands = 1)
        : poses(hands),
          simulation(read_scene(test::in_project(scene)),
                     std::vector(hands, HandDevice{omni_spec(), true}), servo) {}

    void play(const LiveEvent& event) { simulation.play(event, poses); }
    // Requests a long edit.
    void begin(EditAction action) {
        const EditDescription edit = edit_now(std::move(action));
        REQUIRE(simulation.takes_long(edit));
        play(CommandEvent{edit, false, true});
    }
    void step(double travel_m) {
        poses[0].travel_m.x() += travel_m;
        play(PublishEvent{});
        play(StepEvent{});
    }
    const World& world() const { return simulation.world(); }
    const std::vector<Vec3>& positions() const { return world().resource<AtomTable>().positions; }

    NoServo servo;
    std::vector<HandPose> poses;
    LiveSimulation simulation;
};

constexpr const char* hiv = "scenes/hiv/two-hands.toml";

}  // namespace

TEST_CASE("while a long edit is made the world stands still, and nothing of it is lost",
          "[session][edits]") {
    Live live(hiv);
    live.step(1e-4);
    live.step(1e-4);
    const std::vector<Vec3> before = live.positions();
    World expected = live.world();
    UndoHistory history;
    history.apply(expected, edit_now(GrabEdit{"protease_a:25"}));

    live.begin(GrabEdit{"protease_a:25"});
    CHECK(live.simulation.readout().edit_under_way == "grip of protease_a:25");
    // By a thread of its own, or in the end by the one that adopts it.
    const bool has_thread = GENERATE(true, false);
    std::thread worker;
    if (has_thread) worker = std::thread([&] { live.simulation.build_draft(); });
    live.step(1e-4);
    if (has_thread) worker.join();
    CHECK(live.positions() == before);
    CHECK(held_atoms(live.world(), hand_at(live.world(), 0)).size() > 100);
    live.play(AdoptEvent{});

    const Entity hand = hand_at(live.world(), 0);
    CHECK(live.positions() == before);
    CHECK(held_atoms(live.world(), hand) == held_atoms(expected, hand));
    CHECK(live.simulation.readout().edit_under_way.empty());
    CHECK(live.world().resource<Clock>().steps == 2);
    live.step(1e-4);
    CHECK(live.positions() != before);
    live.play(CommandEvent{edit_now(UndoEdit{})});
    CHECK(live.positions() == before);
    CHECK(held_atoms(live.world(), hand).size() > 100);
}

TEST_CASE("a coupling edit is undone in a live session, and begins from the window's settings",
          "[session][edits]") {
    Live live("scenes/water");
    const auto coupling = [&]() -> const CouplingDescription& {
        return live.simulation.scene().coupling;
    };
    LiveSettings settings{coupling(), 1};
    settings.coupling.A_d = 3e7;
    live.play(CommandEvent{settings});
    live.play(CommandEvent{edit_now(CouplingEdit{{"mode=\"5\""}})});
    CHECK(coupling().mode == CouplingMode::NoForce);
    CHECK(coupling().A_d == 3e7);
    live.play(CommandEvent{edit_now(UndoEdit{})});
    CHECK(coupling().mode == CouplingMode::Guarded);
    CHECK(coupling().A_d == 3e7);
    // Undoing another edit leaves it.
    live.play(CommandEvent{edit_now(GrabEdit{"fixed"})});
    live.play(CommandEvent{edit_now(UndoEdit{})});
    CHECK(coupling().A_d == 3e7);
}

TEST_CASE("each hand has settings of its own, which undo brings back", "[session][undo]") {
    Live live("tests/data/four_hands/scene.toml", 3);
    // The second has a coupling of its own, the third has the scene's, as the first.
    const std::size_t other = GENERATE(1, 2);
    const auto now = [&](std::size_t hand) { return settings_of(live.simulation.scene(), hand); };
    const LiveSettings first = now(0), second = now(other);
    const std::size_t untouched = 3 - other;
    const LiveSettings third = now(untouched);
    // One that shares the scene's coupling has what the first has.
    const auto check_untouched = [&](const LiveSettings& of_first) {
        CHECK(now(untouched).period_ms == of_first.period_ms);
        CHECK(now(untouched).coupling == (untouched == 2 ? of_first.coupling : third.coupling));
    };
    LiveSettings changed = second;
    changed.coupling.A_d = 3e7;

    live.play(CommandEvent{changed});
    CHECK(now(0) == first);
    CHECK(now(other) == changed);
    check_untouched(first);
    LiveSettings of_first = first;
    of_first.coupling.A_d = 4e7;
    of_first.period_ms = 2;
    live.play(CommandEvent{of_first});
    CHECK(now(0) == of_first);
    CHECK(now(other).coupling == changed.coupling);
    check_untouched(of_first);
    // Sliders of two hands are two changes.
    live.play(CommandEvent{edit_now(UndoEdit{})});
    CHECK(now(0) == first);
    CHECK(now(other) == changed);
    check_untouched(first);
    live.play(CommandEvent{edit_now(UndoEdit{})});
    CHECK(now(0) == first);
    CHECK(now(other) == second);
    check_untouched(first);
    live.play(CommandEvent{edit_now(RedoEdit{})});
    CHECK(now(other) == changed);
    check_untouched(first);
}

TEST_CASE("edits, settings, additions to the picture and pulls are undone in one order",
          "[session][undo]") {
    Live live("scenes/water");
    const auto readout = [&]() -> const UndoReadout& { return live.simulation.readout().undo; };
    const auto undo = [&] { live.play(CommandEvent{edit_now(UndoEdit{})}); };
    const auto redo = [&] { live.play(CommandEvent{edit_now(RedoEdit{})}); };
    const std::vector<Vec3> start = live.positions();
    LiveSettings settings{live.simulation.scene().coupling, 1};
    const double A_d = settings.coupling.A_d;
    const ViewAdditions labels{{}, {"resid 1"}, {}};

    live.play(CommandEvent{HandLead{0, true}});
    for (int i = 0; i < 5; ++i) live.step(2e-3);
    const std::vector<Vec3> pulled = live.positions();
    REQUIRE(pulled != start);
    CHECK(readout().undo == "pull of moved");
    settings.coupling.A_d = 3e7;
    live.play(CommandEvent{settings});
    CHECK(readout().undo == "change of A_d");
    live.play(CommandEvent{labels});
    CHECK(readout().undo == "change of the picture");
    live.play(CommandEvent{edit_now(PinEdit{{"fixed:1"}})});
    CHECK(readout().undo == "measurement");

    undo();
    CHECK(readout().undo == "change of the picture");
    CHECK(readout().redo == "measurement");
    CHECK(readout().additions == labels);
    undo();
    CHECK(readout().additions == ViewAdditions{});
    CHECK(live.simulation.scene().coupling.A_d == 3e7);
    undo();
    CHECK(live.simulation.scene().coupling.A_d == A_d);
    CHECK(live.positions() == pulled);
    undo();
    CHECK(live.positions() == start);
    CHECK(readout().undo.empty());
    undo();
    CHECK_THAT(live.simulation.readout().problem, Contains("nothing to undo"));
    redo();
    CHECK(live.positions() == pulled);
    redo();
    redo();
    CHECK(live.simulation.scene().coupling.A_d == 3e7);
    CHECK(readout().additions == labels);
    CHECK(readout().redo == "measurement");
    // Another change ends what could be redone.
    live.play(CommandEvent{ViewAdditions{}});
    CHECK(readout().redo.empty());
}

TEST_CASE("a pull lasts from taking hold to letting go", "[session][undo]") {
    Live live("scenes/water");
    const auto undo = [&] { live.play(CommandEvent{edit_now(UndoEdit{})}); };
    std::vector<std::vector<Vec3>> at{live.positions()};
    for (int pull = 0; pull < 3; ++pull) {
        live.play(CommandEvent{HandLead{0, true}});
        for (int i = 0; i < 6; ++i) live.step(2e-3);
        live.play(CommandEvent{HandLead{0, false}});
        live.step(0);
        at.push_back(live.positions());
    }
    // A motion while nobody leads the hand is no pull, nor is a lead that moves nothing.
    live.step(2e-3);
    live.step(-2e-3);
    live.play(CommandEvent{HandLead{0, true}});
    for (int i = 0; i < 3; ++i) live.step(0);
    for (int pull = 2; pull >= 0; --pull) {
        CHECK(live.simulation.readout().undo.undo == "pull of moved");
        undo();
        CHECK((live.positions()[3] - at[pull][3]).norm() < 1e-9);
    }
    CHECK(live.simulation.readout().undo.undo.empty());
    // The hand goes on from there.
    const std::vector<Vec3> before = live.positions();
    live.step(0);
    CHECK(live.positions() == before);
    live.step(2e-3);
    CHECK(live.positions() != before);
}

TEST_CASE("a device that nobody leads by mouse pulls until its clutch is pressed",
          "[session][undo]") {
    NoServo servo;
    LiveSimulation simulation(read_scene(test::in_project("scenes/water")),
                              {HandDevice{omni_spec(), false}}, servo);
    std::vector<HandPose> poses{1};
    const auto pull = [&] {
        for (int i = 0; i < 6; ++i) {
            poses[0].travel_m.x() += 2e-3;
            simulation.play(PublishEvent{}, poses);
            simulation.play(StepEvent{}, poses);
        }
        poses[0].is_clutched = true;
        simulation.play(StepEvent{}, poses);
        poses[0].is_clutched = false;
    };
    pull();
    pull();
    CHECK(simulation.readout().undo.undo == "pull of moved");
    simulation.play(CommandEvent{edit_now(UndoEdit{})}, poses);
    CHECK(simulation.readout().undo.undo == "pull of moved");
    simulation.play(CommandEvent{edit_now(UndoEdit{})}, poses);
    CHECK(simulation.readout().undo.undo.empty());
}

TEST_CASE("a hand that holds on and rests for ten seconds begins another pull", "[session][undo]") {
    Live live("scenes/water");
    live.play(CommandEvent{HandLead{0, true}});
    for (int i = 0; i < 6; ++i) live.step(2e-3);
    const Vec3 first = live.positions()[3];
    for (int i = 0; i < 10'010; ++i) live.step(0);
    for (int i = 0; i < 6; ++i) live.step(2e-3);
    REQUIRE((live.positions()[3] - first).norm() > 0.2);
    live.play(CommandEvent{edit_now(UndoEdit{})});
    CHECK((live.positions()[3] - first).norm() < 0.1);
    CHECK(live.simulation.readout().undo.undo == "pull of moved");
}

TEST_CASE("a slider's changes of one number are one entry, choices are one each",
          "[session][undo]") {
    Live live("scenes/water");
    const auto undo = [&] { live.play(CommandEvent{edit_now(UndoEdit{})}); };
    const LiveSettings first{live.simulation.scene().coupling, 1};
    LiveSettings settings = first;
    const auto set = [&] { live.play(CommandEvent{settings}); };
    for (int i = 1; i <= 20; ++i) {
        settings.coupling.A_d_max = 1e8 + 1e6 * i;
        set();
        live.step(0);
    }
    const LiveSettings slid = settings;
    set();  // the same again is no change
    settings.coupling.mode = CouplingMode::NoForce;
    set();
    settings.coupling.mode = CouplingMode::Guarded;
    set();
    settings.period_ms = 7;
    set();

    CHECK(live.simulation.readout().undo.undo == "change of period_ms");
    undo();
    CHECK(live.simulation.scene().period_ms == 1);
    undo();
    CHECK(live.simulation.scene().coupling.mode == CouplingMode::NoForce);
    undo();
    CHECK(live.simulation.scene().coupling == slid.coupling);
    undo();
    CHECK(live.simulation.scene().coupling == first.coupling);
    CHECK(live.simulation.readout().undo.undo.empty());
}

TEST_CASE("a reset keeps the settings in the history, and no world", "[session][undo]") {
    Live live("scenes/water");
    LiveSettings settings{live.simulation.scene().coupling, 1};
    settings.coupling.mode = CouplingMode::NoForce;
    live.play(CommandEvent{edit_now(PinEdit{{"fixed:1"}})});
    live.play(CommandEvent{settings});
    live.play(CommandEvent{Reset{}});
    CHECK(live.simulation.readout().undo.undo == "change of mode");
    live.play(CommandEvent{edit_now(UndoEdit{})});
    CHECK(live.simulation.scene().coupling.mode == CouplingMode::Guarded);
    CHECK(live.simulation.readout().undo.undo.empty());
}

TEST_CASE("at its limit the history says what it forgets", "[session][undo]") {
    Live live("scenes/water");
    const auto name = [](std::size_t i) { return "resid " + std::to_string(i); };
    live.play(CommandEvent{edit_now(PinEdit{{"fixed:1"}})});
    for (std::size_t i = 1; i < UndoHistory::most_entries; ++i)
        live.play(CommandEvent{ViewAdditions{{}, {name(i)}, {}}});
    CHECK(live.simulation.readout().undo.dropped == 0);
    live.play(CommandEvent{ViewAdditions{}});
    CHECK(live.simulation.readout().undo.dropped == 1);
    CHECK(live.simulation.readout().undo.dropped_name == "measurement");
    // An edit that can no longer be undone stays among those of the session.
    CHECK(live.simulation.list_edits().size() == 1);
}

TEST_CASE("a long edit that is refused says so and changes nothing", "[session][edits]") {
    Live live(hiv);
    live.begin(GrabEdit{"protease_a:2500"});
    live.step(1e-4);
    const std::vector<Vec3> before = live.positions();
    live.play(AdoptEvent{});
    CHECK(live.positions() == before);
    CHECK_THAT(live.simulation.readout().problem, Contains("no residue or atom \"2500\""));
    CHECK(live.simulation.readout().refused_edits == 1);
    CHECK(live.simulation.readout().edit_under_way.empty());
}

TEST_CASE("a scene that is loaded anew forgets the long edit that was under way",
          "[session][edits]") {
    Live live(hiv);
    live.begin(RemoveEdit{"protease_b"});
    live.play(CommandEvent{Reset{}});
    const std::size_t atoms = live.positions().size();
    live.play(AdoptEvent{});
    CHECK(live.positions().size() == atoms);
    CHECK(live.simulation.readout().edit_under_way.empty());
}

TEST_CASE("a scene that is loaded anew has a lesson that has measured nothing yet",
          "[session][lesson]") {
    SceneDescription scene = read_scene(test::in_project("scenes/water"));
    LessonStepDescription way{"way", "text", "task", LessonQuantity::Way, 1.0, {}, 0};
    LessonStepDescription work{"work", "text", "task", LessonQuantity::Work, 1.0, {}, 0};
    scene.lesson = {way, work};
    NoServo servo;
    LiveSimulation simulation(scene, {HandDevice{omni_spec(), true}}, servo);
    std::vector<HandPose> poses{1};
    for (int i = 0; i < 20; ++i) {
        poses[0].travel_m.x() -= 4e-3;  // towards the other water
        simulation.play(PublishEvent{}, poses);
        simulation.play(StepEvent{}, poses);
    }
    const std::vector<double> before = simulation.readout().lesson.values;
    REQUIRE(before.size() == 2);
    REQUIRE(before[0] > 1);
    REQUIRE(before[1] != 0);
    REQUIRE(simulation.readout().resets == 0);

    simulation.play(CommandEvent{Reset{}}, poses);

    CHECK(simulation.readout().resets == 1);
    CHECK(simulation.readout().lesson.values == std::vector<double>{0, 0});
}

TEST_CASE("only what needs new mechanics of many atoms takes long", "[session][edits]") {
    const Live live(hiv), small("scenes/water"), rigid("scenes/hiv");
    CHECK(rigid.simulation.takes_long(edit_now(GrabEdit{"protease_a:25"})));
    CHECK_FALSE(rigid.simulation.takes_long(edit_now(GrabEdit{"protease_a"})));
    CHECK(live.simulation.takes_long(edit_now(ReleaseEdit{})));
    CHECK_FALSE(live.simulation.takes_long(edit_now(UndoEdit{})));
    CHECK_FALSE(live.simulation.takes_long(edit_now(PinEdit{{"protease_a:25 CA"}})));
    CHECK_FALSE(small.simulation.takes_long(edit_now(GrabEdit{"fixed"})));
}

TEST_CASE("what the scene adds to the picture stays when settings are undone", "[session][undo]") {
    SceneDescription scene = read_scene(test::in_project("scenes/water"));
    scene.view.labels = {"resid 1"};
    scene.coupling.feel_pN = {20, 3000};
    NoServo servo;
    LiveSimulation simulation(scene, {HandDevice{omni_spec(), true}}, servo);
    const std::vector<HandPose> poses{1};
    LiveSettings settings{scene.coupling, scene.period_ms};
    settings.coupling.feel_pN.reset();  // a setting that is unset is a change as well

    simulation.play(CommandEvent{settings}, poses);
    CHECK(simulation.readout().undo.undo == "change of feel_pN");
    simulation.play(CommandEvent{edit_now(UndoEdit{})}, poses);

    CHECK(simulation.scene().coupling == scene.coupling);
    CHECK(simulation.readout().undo.additions.labels == scene.view.labels);
}
