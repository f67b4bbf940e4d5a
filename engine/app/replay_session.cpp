#include "app/replay_session.h"

#include "core/load_error.h"
#include "formats/gzip.h"
#include "scene/find_scene.h"
#include "simulation/resources.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// What is played between two looks at commands and clock.
constexpr std::chrono::milliseconds slice{10};
constexpr double slice_ticks = 1e-3 * slice.count() * servo_rate_hz;

Journal read_journal(const fs::path& folder, const SceneDescription& scene) {
    const fs::path file = find_plain_or_packed(folder / journal_name);
    Journal journal = parse_journal(read_recorded_file(file), file.string());
    complete_caps(scene, journal);
    if (journal.ticks.empty())
        throw LoadError({file.string()}, "has no tick; expected a session that had begun");
    return journal;
}

}  // namespace

ReplaySession::ReplaySession(const fs::path& folder, const SceneDescription& scene,
                             const ViewSettings& view, const StageFunction& on_stage)
    : folder_(folder), scene_(scene), journal_(read_journal(folder, scene)), view_(view) {
    player_.emplace(scene_, journal_, on_stage);
    begin_anew();
    thread_ = std::thread([this] { run(); });
}

ReplaySession::~ReplaySession() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    has_command_.notify_one();
    thread_.join();
}

std::size_t ReplaySession::first_recorded() const {
    return journal_.first_recorded.value_or(journal_.ticks.size());
}

// With a player that has played nothing.
void ReplaySession::begin_anew() {
    if (player_->next_tick() > 0) player_.emplace(scene_, journal_);
    check_.emplace(folder_, journal_.ticks.size() - first_recorded(), scene_.every,
                   journal_.devices.size());
    frame_builder_.emplace(scene_, player_->simulation(), view_);
    problem_.clear();
    due_ = 0;
}

void ReplaySession::send(const Command& command) {
    {
        const std::lock_guard lock(mutex_);
        commands_.push_back(command);
    }
    has_command_.notify_one();
}

bool ReplaySession::read_frame(LiveFrame& frame) {
    const bool is_new = frames_.read(frame);
    frame_wanted_ = true;
    return is_new;
}

World ReplaySession::copy_world() {
    const std::lock_guard lock(world_mutex_);
    return player_->simulation().world();
}

bool ReplaySession::pop_ticks(std::span<ServoTick> ticks) noexcept {
    if (!ticks_->pop(ticks[0])) return false;
    for (std::size_t slot = 1; slot < journal_.devices.size();)
        slot += ticks_->pop(ticks[slot]) ? 1 : 0;
    return true;
}

void ReplaySession::change_device(Device& /*device*/, HandOrders* /*orders*/,
                                  std::size_t /*slot*/) {
    throw LoadError({folder_.string()},
                    "is played again: no device takes part. Open its session.toml as a scene to "
                    "take part");
}

void ReplaySession::begin_recording(const fs::path& /*folder*/, bool /*overwrites*/,
                                    const std::optional<TrajectorySettings>& /*trajectory*/) {
    throw LoadError({folder_.string()}, "is a recording already, which is played again");
}

void ReplaySession::run() {
    using Steady = std::chrono::steady_clock;
    Steady::time_point next = Steady::now();
    while (!stopping_) {
        {
            const std::lock_guard lock(world_mutex_);
            take_commands();
            const bool seeks = target_ && player_->next_tick() < *target_ && problem_.empty();
            if (!seeks) target_.reset();
            due_ += seeks ? slice_ticks : is_paused_ ? 0 : speed_ * slice_ticks;
            play(static_cast<std::size_t>(due_));
            due_ -= std::floor(due_);
            if (frame_wanted_.exchange(false)) post_frame();
        }
        next += target_ ? std::chrono::microseconds(100) : std::chrono::microseconds(slice);
        const Steady::time_point now = Steady::now();
        if (now - next > slice) next = now;  // it takes longer than it did
        std::unique_lock lock(mutex_);
        has_command_.wait_until(lock, next, [&] { return stopping_ || !commands_.empty(); });
    }
}

void ReplaySession::take_commands() {
    std::vector<Command> commands;
    {
        const std::lock_guard lock(mutex_);
        commands.swap(commands_);
    }
    for (const Command& command : commands) apply(command);
}

void ReplaySession::apply(const Command& command) {
    if (const auto* const view = std::get_if<ViewSettings>(&command)) {
        view_ = *view;
        frame_builder_->show_as(view_);
    } else if (const auto* const pause = std::get_if<Pause>(&command)) {
        is_paused_ = pause->paused;
    } else if (std::holds_alternative<StepOnce>(command)) {
        is_paused_ = true;
        const World& world = player_->simulation().world();
        due_ += world.resource<Clock>().period_s * servo_rate_hz;
    } else if (std::holds_alternative<Reset>(command)) {
        go_to(0);
    } else if (const auto* const order = std::get_if<ReplayOrder>(&command)) {
        is_paused_ = order->paused.value_or(is_paused_);
        speed_ = order->speed.value_or(speed_);
        if (order->at_s) go_to(*order->at_s);
    }
}

void ReplaySession::go_to(double at_s) {
    const auto tick = static_cast<std::size_t>(
        std::clamp(at_s * servo_rate_hz, 0.0, static_cast<double>(journal_.ticks.size())));
    if (tick < player_->next_tick()) begin_anew();
    target_ = tick;
}

void ReplaySession::play(std::size_t ticks) {
    std::array<ServoTick, most_hands> played{};
    const std::span<ServoTick> hands = std::span(played).first(journal_.devices.size());
    try {
        for (; ticks > 0 && !player_->is_over() && problem_.empty(); --ticks) {
            const bool is_recorded = player_->next_tick() >= first_recorded();
            std::ranges::transform(player_->play_tick(), hands.begin(), &LiveTick::tick);
            if (is_recorded) check_->add(hands);
            ticks_->push(std::span<const ServoTick>(hands));
        }
    } catch (const LoadError& error) {
        problem_ = error.what();
    }
}

std::string ReplaySession::describe_verdict() const {
    if (!problem_.empty()) return problem_;
    if (check_->compared() == 0) return {};
    if (const auto& first = check_->first()) {
        return fmt::format(
            "{} of {} rows differ from what was recorded, the first at {} s ({}: {}, now {}). The "
            "same version and kernels, which session.toml names, give the same digits.",
            check_->different(), check_->compared(), first->time_s, first->column, first->recorded,
            first->played);
    }
    return fmt::format("{} of {} rows compared with what was recorded: the same to the last digit.",
                       check_->compared(), check_->recorded());
}

void ReplaySession::post_frame() {
    const LiveSimulation& simulation = player_->simulation();
    LiveFrame frame = frame_builder_->build(simulation);
    const auto seconds = [](std::size_t ticks) {
        return static_cast<double>(ticks) * servo_tick_s;
    };
    frame.readout.paused = is_paused_;
    frame.readout.replay =
        ReplayState{seconds(player_->next_tick()), seconds(journal_.ticks.size()), speed_,
                    is_paused_, describe_verdict()};
    frames_.post(frame);
}

}  // namespace palpa
