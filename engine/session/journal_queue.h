// What a live session's threads leave for its journal: the simulation's events and the servos'
// ticks. A tick is handed on only after the event that posted what the tick uses, so that every
// beginning of the journal can be played again.
#pragma once
#include "core/ring.h"
#include "haptics/servo.h"
#include "session/live_events.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

class SessionRecorder;

// Numbers of the newest contact model and the newest order that a hand's servo was sent.
struct PostNumbers {
    std::uint64_t contact = 0, order = 0;
};
using AllPostNumbers = std::array<PostNumbers, most_hands>;

class JournalQueue {
public:
    // `posts`: numbers before the first event.
    JournalQueue(std::size_t hands, const AllPostNumbers& posts);

    // The simulation's thread, after the event: `posts` are those up to its end.
    void push(PlayedEvent event, const AllPostNumbers& posts);
    // The servos' thread, of all hands; never waits.
    void push(std::span<const LiveTick> ticks) noexcept { ticks_->push(ticks); }

    // The recorder's thread: all events so far, then the ticks up to the first whose event is still
    // under way, which stays for the next call.
    void hand_to(SessionRecorder& recorder);

    // Number of lost ticks, when the ring was full.
    std::uint64_t dropped() const noexcept { return ticks_->dropped(); }

private:
    struct Event {
        PlayedEvent event;
        AllPostNumbers posts;
    };

    static constexpr std::size_t ring_size = 8192;  // 4 s or more

    std::optional<std::span<const LiveTick>> next_ticks();

    std::size_t hands_;
    std::unique_ptr<Ring<LiveTick, ring_size>> ticks_;
    std::array<LiveTick, most_hands> waiting_{};  // popped tick that is not yet handed on
    bool has_waiting_ = false;
    AllPostNumbers handed_on_;  // posts of the events that the recorder has
    std::mutex event_mutex_;
    std::vector<Event> events_;
};

}  // namespace palpa
