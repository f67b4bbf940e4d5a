#include "session/journal_queue.h"

#include "session/session_recorder.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"

#include <array>
#include <catch2/catch.hpp>

using namespace palpa;

namespace {

LiveTick tick_that_uses(const PostNumbers& posts) {
    LiveTick tick;
    tick.tick.contact.number = posts.contact;
    tick.order = posts.order;
    return tick;
}

}  // namespace

TEST_CASE("a tick is recorded only after the event that posted what it uses",
          "[session][journal]") {
    const test::TemporaryFolder folder;
    SessionRecorder recorder(test::water_scene({}), std::array<HandDevice, 2>{});
    recorder.begin(folder.path() / "recording", false);
    const AllPostNumbers at_start{{{1, 1}, {1, 1}}};
    JournalQueue queue(2, at_start);
    const auto push_ticks = [&](const PostNumbers& first, const PostNumbers& second) {
        queue.push(std::array{tick_that_uses(first), tick_that_uses(second)});
    };
    const auto recorded_ticks = [&] {
        queue.hand_to(recorder);
        return recorder.recorded_s() * servo_rate_hz;
    };

    push_ticks({0, 1}, {1, 1});
    CHECK(recorded_ticks() == Approx(1));
    push_ticks({1, 1}, {2, 1});  // the event is still under way, as are those of all that follow
    push_ticks({1, 1}, {1, 1});
    CHECK(recorded_ticks() == Approx(1));
    queue.push({PublishEvent{}, {0, 0}}, {{{1, 1}, {2, 1}}});
    CHECK(recorded_ticks() == Approx(3));
    push_ticks({1, 2}, {2, 1});
    push_ticks({3, 2}, {2, 1});
    queue.push({HoldEvent{}, {0, 0}}, {{{2, 2}, {2, 1}}});
    CHECK(recorded_ticks() == Approx(4));
    queue.push({HoldEvent{}, {0, 0}}, {{{3, 2}, {2, 1}}});
    CHECK(recorded_ticks() == Approx(5));
    CHECK(queue.dropped() == 0);
}
