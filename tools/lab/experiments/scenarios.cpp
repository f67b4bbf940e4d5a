#include "tools/lab/experiments/scenarios.h"

#include "core/draws.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "tools/lab/experiments/disturbances.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

namespace palpa {
namespace {

constexpr double rest_s = 8;  // behind the way out

std::vector<std::string> draw_scenario(Draws& draws) {
    constexpr double lead_s = 0.3;
    std::vector<std::string> settings = draw_hand(draws);
    const auto set = [&](const char* key, const auto& value) {
        settings.push_back(fmt::format("{}={}", key, value));
    };
    set("hand.start_angstrom", draws.between(2.7, 10));
    const double depth_mm = draws.between(20, 145), fastest_mm_per_s = draws.scale(30, 600);
    // Minimum jerk is fastest in the middle, at 15/8 of the mean.
    const double way_s = 15.0 / 8 * depth_mm / fastest_mm_per_s, pause_s = draws.between(0, 1);
    const double far = depth_mm / 2;
    const double in_s = lead_s + way_s, out_s = in_s + pause_s + 1e-3, end_s = out_s + way_s;
    settings.push_back(
        fmt::format("hand.path=[[{:.6f}, {:.4f}], [{:.6f}, {:.4f}], [{:.6f}, {:.4f}], "
                    "[{:.6f}, {:.4f}]]",
                    lead_s, far, in_s, -far, out_s, -far, end_s, far));
    set("run.seconds", fmt::format("{:.3f}", end_s + rest_s));
    return settings;
}

// Work (J) that the static law, cut at the clamp, does on the hand while the molecule goes from one
// distance (Å) to another: the integral of f(F) A_d.
double find_static_work(const SceneDescription& scene, const World& world, double from, double to) {
    const ServoSettings servo = build_servo_settings(scene, world, 0);
    const CouplingLaws& laws = coupling_of(world, hand_at(world, 0)).laws;
    const double clamp_newton = servo.safety.clamp_newton;
    const auto steps = static_cast<int>(std::ceil(std::abs(to - from) / 1e-3)) + 1;
    const double width = (to - from) / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const LineForce line = force_along_line_at(world, from + (i + 0.5) * width);
        const double F_m = line.force * units::newton_per_kcal_per_mol_angstrom;
        const double A_d = gain_where(servo, laws, line);
        const double F_h = hand_force(laws.force, F_m);
        sum += std::clamp(F_h, -clamp_newton, clamp_newton) * A_d;
    }
    return sum * width * units::metre_per_angstrom;
}

// A molecule taken by an edit may move in space, where the force law of one axis does not apply.
bool is_on_axis(const ServoTick& tick) noexcept { return tick.contact.active_freedom <= 1; }

// Stretches of a run in which the whole force of the law came through, each against the static law
// on its own: in between a fault or an edit may take force, and with it energy, from the hand, or
// give it back.
class Stretches {
public:
    Stretches(const SceneDescription& scene, const World& world, const WatchedDevice& device)
        : scene_(scene), world_(world), device_(device) {}

    void add(const ServoTick& tick, bool is_disturbed) {
        const bool is_whole = !is_disturbed && tick.stage <= SafetyStage::ThermalLimit &&
                              tick.reason == SafetyStage::None && !tick.contact.is_still &&
                              is_on_axis(tick);
        ++ticks_;
        if (!is_whole) return close();
        place_ = tick.contact.molecule.place_angstrom.x();
        work_J_ = device_.work_J();
        judged_ += is_open_ ? 1 : 0;
        if (is_open_) return;
        // A force that slews is not yet the law's, and overtravel is a spring that is still loaded.
        if (tick.stage == SafetyStage::Slewed || !tick.overtravel_m.isZero(1e-9)) return;
        is_open_ = true;
        first_place_ = place_;
        first_work_J_ = work_J_;
    }

    // The most that one of them generated, J.
    double finish() {
        close();
        return most_J_;
    }

    double share() const { return ticks_ > 0 ? judged_ / ticks_ : 0; }

private:
    void close() {
        if (!std::exchange(is_open_, false)) return;
        const double by_law = find_static_work(scene_, world_, first_place_, place_);
        most_J_ = std::max(most_J_, work_J_ - first_work_J_ - by_law);
    }

    const SceneDescription& scene_;
    const World& world_;
    const WatchedDevice& device_;
    bool is_open_ = false;
    double first_place_ = 0, place_ = 0;  // Å
    double first_work_J_ = 0, work_J_ = 0;
    double most_J_ = 0;
    double ticks_ = 0, judged_ = 0;
};

}  // namespace

std::vector<std::string> draw_hand(Draws& draws) {
    std::vector<std::string> settings{"hand.stroke=path"};
    const auto set = [&](const char* key, const auto& value) {
        settings.push_back(fmt::format("{}={}", key, value));
    };
    set("hand.grip", grip_names[1 + draws.below(grip_names.size() - 1)]);
    set("device.friction_N", draws.below(3) == 0 ? 0.0 : draws.between(0, 0.5));
    set("device.inertia_kg", draws.scale(0.03, 0.15));
    set("device.viscosity_N_s_per_m", draws.between(0.05, 0.5));
    set("device.servo_delay_ticks", draws.below(2));
    set("run.period_ms", std::lround(draws.scale(1, 100)));
    return settings;
}

void check_scenarios(const ScenarioOptions& options) {
    const SceneDescription scene = read_scene(options.scene, options.settings);
    for (const MoleculeDescription& molecule : scene.molecules) {
        if (molecule.name != scene.hands.front().grab.molecule || molecule.motion == Motion::AlongX)
            continue;
        throw LoadError(scene.place_of("grab.molecule"),
                        "moves in space, where a path out and back does work; expected a molecule "
                        "with motion along-x (for space use palpa-lab closed-paths)");
    }
}

bool ScenarioResult::is_calm() const noexcept {
    constexpr double rounding = 1e-9;
    return generated_J <= most_generated_J && ripple_N < most_ripple_N && !went_through &&
           !was_held_back && most_newton <= clamp_newton + rounding &&
           most_change_newton <= most_slew_newton + rounding;
}

ScenarioResult play_scenario(const ScenarioOptions& options, std::size_t number) {
    Draws draws(options.seed, number);
    ScenarioResult result;
    result.settings = draw_scenario(draws);
    Disturbances disturbances;
    if (options.is_disturbed) {
        const double end_s = read_scene(options.scene, result.settings).seconds - rest_s;
        disturbances = draw_disturbances(draws, end_s);
        std::ranges::copy(disturbances.settings, std::back_inserter(result.settings));
    }
    result.settings.insert(result.settings.end(), options.settings.begin(), options.settings.end());
    SceneDescription scene = read_scene(options.scene, result.settings);
    scene.edits = disturbances.edits;
    World world = load_world(scene);
    EmulatedOmni omni(build_emulated_omni(scene, world));
    WatchedDevice watched(omni);
    FaultyDevice device(watched, disturbances.faults);
    Stretches stretches(scene, world, watched);
    std::uint64_t ticks = 0;
    const auto watch = [&](const ServoTick& tick) {
        const double time_s = static_cast<double>(ticks++) * servo_tick_s;
        stretches.add(tick, is_disturbed(disturbances, time_s, 1e-3 * scene.period_ms));
    };
    const double start = grabbed_distance(world);
    const Summary summary = run_headless(scene, world, device, {}, nullptr, {}, {}, watch);
    result.net_work_J = watched.work_J();
    if (scene.edits.empty())
        result.over_all_J =
            result.net_work_J - find_static_work(scene, world, start, grabbed_distance(world));
    result.generated_J = options.is_disturbed ? stretches.finish() : result.over_all_J.value_or(0);
    result.judged_share = stretches.share();
    result.most_newton = watched.most_newton();
    result.most_change_newton = watched.most_change_newton();
    result.clamp_newton = coupling_of(scene, 0).clamp_N;
    result.faults = disturbances.faults.size();
    result.edits = disturbances.edits.size();
    result.ripple_N = summary.ripple ? summary.ripple->rms : 0;
    result.closest_angstrom = summary.closest_angstrom;
    result.went_through = summary.went_through && summary.is_on_axis;
    result.was_held_back = disturbances.faults.empty() && disturbances.edits.empty() &&
                           summary.gravest > SafetyStage::ThermalLimit;
    result.clamped_share = summary.clamped_share;
    return result;
}

std::vector<ScenarioResult> play_scenarios(
    const ScenarioOptions& options,
    const std::function<void(std::size_t number, const ScenarioResult&)>& on_result) {
    std::vector<ScenarioResult> results;
    for (std::size_t i = options.first; i < options.first + options.count; ++i) {
        results.push_back(play_scenario(options, i));
        if (on_result) on_result(i, results.back());
    }
    return results;
}

}  // namespace palpa
