// A recorded session of a window is played again behind a window: the same world, and nothing else.
#include "app/replay_session.h"

#include "app/live_session.h"
#include "core/files.h"
#include "devices/mouse_handle.h"
#include "formats/gzip.h"
#include "session/recording.h"
#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

using namespace palpa;
using Catch::Contains;

namespace {

bool wait_until(WindowSession& session, LiveFrame& frame, std::vector<ServoTick>& ticks,
                const std::function<bool()>& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    ServoTick tick;
    while (std::chrono::steady_clock::now() < end) {
        while (session.pop_ticks({&tick, 1})) ticks.push_back(tick);
        if (session.read_frame(frame) && is_so()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

// Leads the water in, with another mode on the way, and adds a third one.
std::vector<glm::vec3> record(const std::filesystem::path& folder) {
    MouseHandleSettings settings = mouse_handle_of(hand_model(HandGrip::Medium));
    HandOrders orders;
    settings.orders = &orders;
    MouseHandle mouse(settings);
    const SceneDescription scene = test::water_scene();
    LiveSession live(scene, ViewSettings{}, mouse, &orders);
    LiveFrame frame;
    std::vector<ServoTick> ticks;
    const auto wait = [&](std::uint64_t steps) {
        const std::uint64_t from = frame.readout.steps;
        REQUIRE(
            wait_until(live, frame, ticks, [&] { return frame.readout.steps >= from + steps; }));
    };
    wait(10);
    live.begin_recording(folder);
    live.move_hand(Vec3(-0.04, 0, 0));
    wait(150);
    LiveSettings changed{scene.coupling, scene.period_ms};
    changed.coupling.mode = CouplingMode::ConstantForceConstantDisplacement;
    live.send(changed);
    live.send(edit_now(AddEdit{"TIP3", "", "third", {0, 0, 9}}));
    wait(150);
    live.send(Pause{});
    REQUIRE(wait_until(live, frame, ticks, [&] { return frame.readout.paused; }));
    live.end_recording();
    return frame.places;
}

}  // namespace

TEST_CASE("a recorded session is played again in a window, to the same world",
          "[app][threads][replay]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    const std::vector<glm::vec3> last = record(recording);
    const SceneDescription scene = read_recorded_scene(recording);
    ReplaySession replay(recording, scene, ViewSettings{});
    LiveFrame frame;
    std::vector<ServoTick> ticks;
    const auto state = [&] { return frame.readout.replay.value(); };
    const auto ends = [&] {
        return wait_until(replay, frame, ticks, [&] { return state().at_s >= state().length_s; });
    };

    // What would change it is passed over.
    replay.send(edit_now(RemoveEdit{"moved"}));
    replay.send(ReplayOrder{.paused = {}, .speed = 10, .at_s = {}});
    REQUIRE(ends());

    CHECK_THAT(state().verdict, Contains("the same to the last digit"));
    CHECK(frame.places == last);
    CHECK(frame.hands[0].settings.coupling.mode == CouplingMode::ConstantForceConstantDisplacement);
    CHECK(static_cast<double>(ticks.size()) == Approx(1e3 * state().length_s));
    for (std::size_t i = 1; i < ticks.size(); ++i)
        REQUIRE(ticks[i].reading.time_s >= ticks[i - 1].reading.time_s);

    // Back to the beginning, where it stands until it goes on, to the same end.
    replay.send(Pause{});
    replay.send(Reset{});
    REQUIRE(wait_until(replay, frame, ticks, [&] { return state().at_s == 0; }));
    CHECK(frame.places.size() == 6);
    replay.send(ReplayOrder{.paused = {}, .speed = {}, .at_s = state().length_s / 2});
    REQUIRE(wait_until(replay, frame, ticks,
                       [&] { return state().at_s >= state().length_s / 2 - 0.01; }));
    CHECK(state().is_paused);
    replay.send(Pause{false});
    REQUIRE(ends());
    CHECK(frame.places == last);
    CHECK_THAT(state().verdict, Contains("the same to the last digit"));
    CHECK_THAT(test::load_error_of([&] { replay.begin_recording(folder.path() / "b", false, {}); }),
               Contains("is a recording already"));
}

TEST_CASE("a replay says where a session differs from what was recorded",
          "[app][threads][replay]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path recording = folder.path() / "recording";
    (void)record(recording);
    // Another force in one row.
    std::string trace = read_recorded_file(recording / "trace.csv");
    std::size_t line = 0;
    for (int i = 0; i < 100; ++i) line = trace.find('\n', line) + 1;
    const std::size_t comma = trace.find(',', line) + 1;
    trace.insert(comma, trace[comma] == '-' ? "" : "-");
    trace.insert(comma + 1, "1");
    write_text_file(recording / "trace.csv", trace);  // which counts more than trace.csv.gz

    ReplaySession replay(recording, read_recorded_scene(recording), ViewSettings{});
    LiveFrame frame;
    std::vector<ServoTick> ticks;
    replay.send(ReplayOrder{.paused = {}, .speed = 10, .at_s = {}});
    REQUIRE(wait_until(replay, frame, ticks, [&] {
        return frame.readout.replay->at_s >= frame.readout.replay->length_s;
    }));
    CHECK_THAT(frame.readout.replay->verdict,
               Contains("1 of") && Contains("rows differ") && Contains("handle_x_m"));
}
