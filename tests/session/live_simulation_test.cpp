// Edits that take longer than a step: made beside the steps, adopted between two.
#include "session/live_simulation.h"

#include "haptics/device.h"
#include "scene/read_scene.h"
#include "simulation/held.h"
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
    explicit Live(const char* scene)
        : simulation(read_scene(test::in_project(scene)), {HandDevice{omni_spec(), true}}, servo) {}

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
    std::vector<HandPose> poses{1};
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
    EditHistory history;
    history.apply(expected, edit_now(TakeEdit{"protease_a:25"}));

    live.begin(TakeEdit{"protease_a:25"});
    CHECK(live.simulation.readout().edit_under_way == "take");
    // By a thread of its own, or in the end by the one that adopts it.
    const bool has_thread = GENERATE(true, false);
    std::thread worker;
    if (has_thread) worker = std::thread([&] { live.simulation.build_draft(); });
    live.step(1e-4);
    if (has_thread) worker.join();
    CHECK(live.positions() == before);
    CHECK(held_atoms(live.world(), first_hand(live.world())).size() > 100);
    live.play(AdoptEvent{});

    const Entity hand = first_hand(live.world());
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
    // Undoing anything else leaves it.
    live.play(CommandEvent{edit_now(TakeEdit{"fixed"})});
    settings.coupling.A_d = 4e7;
    live.play(CommandEvent{settings});
    live.play(CommandEvent{edit_now(UndoEdit{})});
    CHECK(coupling().A_d == 4e7);
}

TEST_CASE("a long edit that is refused says so and changes nothing", "[session][edits]") {
    Live live(hiv);
    live.begin(TakeEdit{"protease_a:2500"});
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
    CHECK(rigid.simulation.takes_long(edit_now(TakeEdit{"protease_a:25"})));
    CHECK_FALSE(rigid.simulation.takes_long(edit_now(TakeEdit{"protease_a"})));
    CHECK(live.simulation.takes_long(edit_now(LetGoEdit{})));
    CHECK_FALSE(live.simulation.takes_long(edit_now(UndoEdit{})));
    CHECK_FALSE(live.simulation.takes_long(edit_now(PinEdit{{"protease_a:25 CA"}})));
    CHECK_FALSE(small.simulation.takes_long(edit_now(TakeEdit{"fixed"})));
}
