#include "session/journal_queue.h"

#include "session/session_recorder.h"

#include <utility>

namespace palpa {
namespace {

bool uses_what_is_posted(std::span<const LiveTick> ticks, const AllPostNumbers& posts) {
    for (std::size_t slot = 0; slot < ticks.size(); ++slot) {
        const LiveTick& tick = ticks[slot];
        if (tick.tick.contact.number > posts[slot].contact || tick.order > posts[slot].order)
            return false;
    }
    return true;
}

}  // namespace

JournalQueue::JournalQueue(std::size_t hands, const AllPostNumbers& posts)
    : hands_(hands), ticks_(std::make_unique<Ring<LiveTick, ring_size>>()), handed_on_(posts) {}

void JournalQueue::push(PlayedEvent event, const AllPostNumbers& posts) {
    const std::lock_guard lock(event_mutex_);
    events_.push_back({std::move(event), posts});
}

void JournalQueue::hand_to(SessionRecorder& recorder) {
    std::vector<Event> events;
    {
        const std::lock_guard lock(event_mutex_);
        events.swap(events_);
    }
    for (const Event& event : events) {
        recorder.add(event.event);
        handed_on_ = event.posts;
    }
    while (const auto ticks = next_ticks()) {
        if (!uses_what_is_posted(*ticks, handed_on_)) return;
        has_waiting_ = false;
        recorder.add(*ticks);
    }
}

// The servo pushes those of all hands or none.
std::optional<std::span<const LiveTick>> JournalQueue::next_ticks() {
    const std::span ticks = std::span(waiting_).first(hands_);
    if (!has_waiting_) {
        if (!ticks_->pop(ticks[0])) return std::nullopt;
        for (std::size_t slot = 1; slot < hands_;) slot += ticks_->pop(ticks[slot]) ? 1 : 0;
        has_waiting_ = true;
    }
    return ticks;
}

}  // namespace palpa
