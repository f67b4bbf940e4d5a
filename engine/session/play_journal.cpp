#include "session/play_journal.h"

#include "core/load_error.h"
#include "session/servo_bank.h"

#include <fmt/format.h>
#include <algorithm>
#include <deque>
#include <map>
#include <variant>
#include <vector>

namespace palpa {
namespace {

[[noreturn]] void fail(const std::string& what) {
    throw LoadError({"journal.txt"},
                    fmt::format("{}; expected the journal of this scene and program", what));
}

// Keeps what was posted until its tick.
class KeptPosts final : public ServoLine {
public:
    explicit KeptPosts(std::size_t hands) : hands_(hands) {}

    void post(std::size_t slot, const LocalContactModel& contact, std::uint64_t number) override {
        LocalContactModel& kept = hands_[slot].contacts[number];
        kept = contact;
        kept.model.number = hands_[slot].last_contact = number;
    }
    void post(std::size_t slot, const ServoOrder& order) override {
        hands_[slot].orders[order.number] = order;
        hands_[slot].last_order = order.number;
    }

    bool has(std::size_t slot, const JournalHand& hand) const {
        return hand.contact <= hands_[slot].last_contact && hand.order <= hands_[slot].last_order;
    }

    // Gives the servo what is in force in this tick, where that is new.
    void deliver(std::size_t slot, const JournalHand& hand, ServoBank& servos) {
        Hand& kept = hands_[slot];
        if (hand.contact != kept.taken_contact)
            servos.exchange(slot).contact.post(take(kept.contacts, hand.contact));
        if (hand.order != kept.taken_order) servos.orders(slot).post(take(kept.orders, hand.order));
        kept.taken_contact = hand.contact;
        kept.taken_order = hand.order;
    }

private:
    struct Hand {
        std::map<std::uint64_t, LocalContactModel> contacts;
        std::map<std::uint64_t, ServoOrder> orders;
        std::uint64_t last_contact = 0, last_order = 0, taken_contact = 0, taken_order = 0;
    };

    // Older ones are taken by nobody any more.
    template <class Value>
    static Value take(std::map<std::uint64_t, Value>& kept, std::uint64_t number) {
        const auto found = kept.find(number);
        if (found == kept.end())
            fail(fmt::format("refers to result {}, which is no longer available", number));
        Value value = std::move(found->second);
        kept.erase(kept.begin(), std::next(found));
        return value;
    }

    std::vector<Hand> hands_;
};

}  // namespace

class JournalPlayer::Player {
public:
    Player(const SceneDescription& scene, const Journal& journal, const StageFunction& on_stage,
           const StepsFunction& on_step)
        : journal_(journal),
          on_step_(on_step),
          posts_(journal.devices.size()),
          simulation_(scene, journal.devices, posts_, {}, on_stage),
          servos_(journal.devices.size()),
          poses_(journal.devices.size()) {
        constexpr FileVersion first_with_one_history{2, 2};
        if (journal.version < first_with_one_history) simulation_.undo_edits_alone();
    }

    std::span<const LiveTick> play_tick(std::size_t tick) {
        const JournalTick& when = journal_.ticks[tick];
        const std::span<const JournalHand> hands = journal_.hands_of(tick);
        for (std::size_t slot = 0; slot < hands.size(); ++slot) {
            while (!posts_.has(slot, hands[slot])) play_event();
            posts_.deliver(slot, hands[slot], servos_);
        }
        if (when.is_fresh && tick > 0) servos_.begin_anew();
        servos_.take_orders();
        readings_.clear();
        for (const JournalHand& hand : hands) readings_.push_back(hand.reading);
        servos_.tick(readings_, when.now_s, when.is_ending);
        for (std::size_t slot = 0; slot < hands.size(); ++slot) {
            HandPose pose;
            if (servos_.exchange(slot).hand.read(pose)) poses_[slot].push_back(pose);
        }
        // Events after the last tick, so that the world ends as in the recorded session.
        while (tick + 1 == journal_.ticks.size() && can_play_event()) play_event();
        return servos_.ticks();
    }

    const Journal& journal() const noexcept { return journal_; }
    const LiveSimulation& simulation() const noexcept { return simulation_; }

private:
    // There is one, and its poses are known, which those of a journal that was cut off may not be.
    bool can_play_event() const {
        if (next_event_ == journal_.events.size()) return false;
        const std::vector<std::uint64_t>& needed = journal_.events[next_event_].poses;
        for (std::size_t slot = 0; slot < poses_.size(); ++slot) {
            const bool is_known =
                !poses_[slot].empty() && needed[slot] <= poses_[slot].back().number;
            if (needed[slot] > 0 && !is_known) return false;
        }
        return true;
    }

    void play_event() {
        if (next_event_ == journal_.events.size()) fail("uses a result that no step has produced");
        const PlayedEvent& played = journal_.events[next_event_++];
        std::vector<HandPose> poses(poses_.size());
        for (std::size_t slot = 0; slot < poses.size(); ++slot)
            poses[slot] = find_pose(slot, played.poses[slot]);
        simulation_.play(played.event, poses);
        if (on_step_ && std::holds_alternative<StepEvent>(played.event)) on_step_(simulation_);
    }

    // Events never go back to older ones.
    HandPose find_pose(std::size_t slot, std::uint64_t number) {
        if (number == 0) return {};
        std::deque<HandPose>& kept = poses_[slot];
        while (!kept.empty() && kept.front().number < number) kept.pop_front();
        if (kept.empty() || kept.front().number != number)
            fail(fmt::format("an event begins from pose {} of hand {}, which does not exist yet",
                             number, slot + 1));
        return kept.front();
    }

    const Journal& journal_;
    const StepsFunction on_step_;
    KeptPosts posts_;
    LiveSimulation simulation_;
    ServoBank servos_;
    std::vector<std::deque<HandPose>> poses_;  // that events may begin from
    std::vector<DeviceReading> readings_;
    std::size_t next_event_ = 0;
};

JournalPlayer::JournalPlayer(const SceneDescription& scene, const Journal& journal,
                             const StageFunction& on_stage, const StepsFunction& on_step) {
    const std::size_t hands = scene.hands.size();
    if (journal.devices.size() > hands)
        fail(fmt::format("moves {} hands, but the scene has {}", journal.devices.size(), hands));
    player_ = std::make_unique<Player>(scene, journal, on_stage, on_step);
}

JournalPlayer::JournalPlayer(JournalPlayer&&) noexcept = default;
JournalPlayer& JournalPlayer::operator=(JournalPlayer&&) noexcept = default;
JournalPlayer::~JournalPlayer() = default;

bool JournalPlayer::is_over() const noexcept { return next_ == player_->journal().ticks.size(); }

std::span<const LiveTick> JournalPlayer::play_tick() { return player_->play_tick(next_++); }

const LiveSimulation& JournalPlayer::simulation() const noexcept { return player_->simulation(); }

void play_journal(const SceneDescription& scene, const Journal& journal,
                  const LiveTicksFunction& on_ticks, const ProgressFunction& progress,
                  const StepsFunction& on_step) {
    const std::size_t first = journal.first_recorded.value_or(journal.ticks.size());
    bool is_recorded = first == 0;
    JournalPlayer player(scene, journal, {}, [&](const LiveSimulation& simulation) {
        if (is_recorded && on_step) on_step(simulation);
    });
    constexpr std::size_t between_progress = 100;
    while (!player.is_over()) {
        const std::size_t tick = player.next_tick();
        is_recorded = tick >= first;
        const std::span<const LiveTick> ticks = player.play_tick();
        if (tick >= first) on_ticks(ticks);
        if (progress && tick % between_progress == 0)
            progress(static_cast<double>(tick) / static_cast<double>(journal.ticks.size()));
    }
    if (progress) progress(1);
}

}  // namespace palpa
