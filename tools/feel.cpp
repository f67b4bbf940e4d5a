#include "tools/feel.h"

#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "scene/read_scene.h"
#include "session/feel.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "tools/bench_row.h"
#include "tools/hands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr double most_share = 0.9;  // of samples that have to be within the tolerance

std::array<double, 2> range_called(const std::string& text) {
    const std::size_t colon = text.find(':');
    const auto lo = find_real(text.substr(0, colon));
    const auto hi = find_real(colon == std::string::npos ? "" : text.substr(colon + 1));
    if (!lo || !hi) {
        throw LoadError({"--ranges"},
                        fmt::format("'{}' is no range; expected WEAKEST:STRONGEST in pN", text));
    }
    return {*lo, *hi};
}

// ---- references --------------------------------------------------------------------------------

// The field of all pairs in double, where nothing moves by itself.
Vec3 find_rigid_force(const Simulation& simulation, const MoleculePose& pose) {
    FieldPoints group = grabbed_points(simulation);
    const Mat3 turn = pose.orientation.toRotationMatrix();
    std::vector<Vec3> positions;
    for (const Vec3& arm : simulation.grabbed_shape)
        positions.emplace_back(simulation.anchor + pose.place_angstrom + turn * arm);
    group.positions = positions;
    return evaluate_pair_field(group, environment_points(simulation), pair_rule(simulation)).force;
}

// All joints and all pairs, without choices of joints or audits.
class RelaxedReference {
public:
    RelaxedReference(SceneDescription scene, const Flexible& flexible) {
        scene.statics.active = StaticsDescription{}.active;
        scene.statics.steps = 1;
        scene.statics.budget_us.reset();
        scene.statics.cutoff_angstrom.reset();
        scene.coupling.feel_within_pN.reset();
        flexible_ = build_flexible(scene, flexible.model, flexible.grabbed, flexible.state.tether);
    }

    // On what is held (kcal/mol/Å), from where a state is, once that is held at that place (Å):
    // after 200 of the paper's steps, whatever was asked, and how much the last 50 of them still
    // changed.
    struct Found {
        Vec3 force;
        double change;
    };
    Found find_force(const TorsionState& state, const Vec3& held_at) {
        constexpr int steps = 200, last_steps = 50;
        // A first step is short, and they grow by a fifth.
        flexible_.state = state;
        flexible_.statics.h = 0;
        update_positions(flexible_.model, flexible_.state);
        start_flexible(flexible_);
        move_held(flexible_, held_at - find_held(flexible_));
        Vec3 before = Vec3::Zero();
        for (int i = 0; i < steps; ++i) {
            if (i == steps - last_steps) before = find_force_on_held(flexible_);
            (void)step_flexible(flexible_);
        }
        const Vec3 force = find_force_on_held(flexible_);
        return {force, (force - before).norm()};
    }

private:
    Flexible flexible_;
};

// Takes every tick of a run, and looks closely at some.
class FeelWatch {
public:
    FeelWatch(const SceneDescription& scene, const Simulation& simulation, std::size_t samples,
              double within_pN)
        : simulation_(simulation), samples_(samples), within_pN_(within_pN) {
        ticks_of_run_ = scene.seconds / servo_tick_s;
        if (simulation.flexible) reference_.emplace(scene, *simulation.flexible);
    }

    void add(const ServoTick& tick) {
        largest_hand_N_ = std::max(largest_hand_N_, tick.sent_newton.norm());
        const double next = (static_cast<double>(errors_pN_.size()) + 0.5) * ticks_of_run_ /
                            static_cast<double>(samples_);
        if (errors_pN_.size() < samples_ && static_cast<double>(tick_) >= next)
            errors_pN_.push_back(find_error(tick.touch));
        ++tick_;
    }

    FeelResult take() {
        FeelResult result;
        result.largest_hand_N = largest_hand_N_;
        result.errors_pN = std::move(errors_pN_);
        if (!changes_pN_.empty()) result.moving_pN = quantile(changes_pN_, 0.5);
        std::vector<double> sorted = result.errors_pN;
        if (sorted.empty()) return result;
        std::ranges::sort(sorted);
        const auto count = static_cast<double>(sorted.size());
        const double rank = std::ceil(most_share * count - 1e-9) - 1;
        result.ninety_pN = sorted[static_cast<std::size_t>(std::max(0.0, rank))];
        const auto within =
            std::ranges::count_if(sorted, [&](double error) { return error <= within_pN_; });
        result.within_share = static_cast<double>(within) / count;
        return result;
    }

private:
    double find_error(const TouchModel& told) {
        constexpr double newton = units::newton_per_kcal_per_mol_angstrom;
        Vec3 force = Vec3::Zero();
        if (reference_ && simulation_.flexible) {
            const auto found = reference_->find_force(
                simulation_.flexible->state, simulation_.anchor + told.molecule.place_angstrom);
            force = found.force;
            changes_pN_.push_back(1e12 * newton * found.change);
        } else {
            force = find_rigid_force(simulation_, told.molecule);
        }
        return 1e12 * (told.force_newton - newton * (told.projector * force)).norm();
    }

    const Simulation& simulation_;
    std::size_t samples_;
    double within_pN_, ticks_of_run_ = 0, largest_hand_N_ = 0;
    std::optional<RelaxedReference> reference_;
    std::uint64_t tick_ = 0;
    std::vector<double> errors_pN_, changes_pN_;
};

// The options' settings, and what is asked.
std::vector<std::string> list_settings(const FeelOptions& options,
                                       const std::array<double, 2>& range_pN, double within_pN) {
    std::vector<std::string> settings = options.settings;
    settings.push_back(fmt::format("coupling.feel_pN=[{}, {}]", format_real(range_pN[0]),
                                   format_real(range_pN[1])));
    settings.push_back(fmt::format("coupling.feel_within_pN={}", format_real(within_pN)));
    return settings;
}

FeelResult play(const FeelOptions& options, const std::array<double, 2>& range_pN,
                double within_pN) {
    const SceneDescription scene =
        read_scene(options.scene, list_settings(options, range_pN, within_pN));
    Simulation simulation = load_simulation(scene);
    EmulatedOmni device(build_emulated_omni(scene, simulation));
    FeelWatch watch(scene, simulation, options.samples, within_pN);
    const Summary summary = run_headless(scene, simulation, device, {}, nullptr, {}, {},
                                         [&](const ServoTick& tick) { watch.add(tick); });
    FeelResult result = watch.take();
    result.range_pN = range_pN;
    result.within_pN = within_pN;
    result.summary = summary;
    return result;
}

// ---- what is told ------------------------------------------------------------------------------

nlohmann::ordered_json as_json(const FeelResult& r) {
    const Feel feel = r.summary.feel.value_or(Feel{});
    return {{"range_pN", r.range_pN},
            {"within_pN", r.within_pN},
            {"ends_N", feel.ends_newton},
            {"largest_hand_N", r.largest_hand_N},
            {"stiffest_share_of_cap", feel.stiffest_share},
            {"samples", r.errors_pN.size()},
            {"within_share", r.within_share},
            {"error_90_pN", r.ninety_pN},
            {"errors_pN", r.errors_pN},
            {"reference_moving_pN", r.moving_pN},
            {"audits", feel.audits},
            {"audits_within_share", feel.within_share},
            {"audits_error_90_pN", feel.ninety_pN},
            {"active_mean", feel.active},
            {"steps_mean", feel.steps},
            {"step_median_us", r.summary.step_median_us},
            {"largest_raise_of_A_d", feel.largest_raise},
            {"gave_way", find_yielding(feel).all()},
            {"unsaid", r.unsaid()}};
}

void print_feel_header() {
    fmt::print(
        "| range, pN | within, pN | felt at both ends, N | at most, N | of the cap, % | samples "
        "within, % | 90 %, pN | still moving, pN | audits: 90 %, pN | active | steps | step, ms | "
        "gave way |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
}

void print_row(const FeelResult& r) {
    const Feel feel = r.summary.feel.value_or(Feel{});
    const std::vector<std::string> gave_way = find_yielding(feel).all();
    fmt::print(
        "| {:.6g} to {:.6g} | {:.6g} | {:.3f}, {:.3f} | {:.2f} | {:.1f} | {:.0f} | {:.3g} | {:.3g} "
        "| {} | "
        "{:.0f} | {:.1f} | {:.3g} | {} |\n",
        r.range_pN[0], r.range_pN[1], r.within_pN, feel.ends_newton[0], feel.ends_newton[1],
        r.largest_hand_N, 100 * feel.stiffest_share, 100 * r.within_share, r.ninety_pN, r.moving_pN,
        feel.audits > 0 ? fmt::format("{:.3g}", feel.ninety_pN) : "", feel.active, feel.steps,
        1e-3 * r.summary.step_median_us,
        gave_way.empty() ? "nothing" : fmt::format("{}", fmt::join(gave_way, "; ")));
    for (const std::string& what : r.unsaid()) fmt::print(stderr, "not said: {}\n", what);
    std::fflush(stdout);
}

}  // namespace

std::vector<std::string> FeelResult::unsaid() const {
    const Feel feel = summary.feel.value_or(Feel{});
    const Yielding yielding = find_yielding(feel);
    std::vector<std::string> unsaid;
    const auto [weakest, strongest] = feel.ends_newton;
    if (!(weakest >= PerceptualForceLaw::least_felt && strongest <= PerceptualForceLaw::most_felt))
        unsaid.push_back(fmt::format("the ends are felt as {} and {} N", weakest, strongest));
    constexpr double rounding = 1e-9;
    if (feel.stiffest_share > 1 + rounding)
        unsaid.push_back(fmt::format("{:.3g} of the cap was felt", feel.stiffest_share));
    if (!(within_share >= most_share) && yielding.tolerance.empty()) {
        unsaid.push_back(
            fmt::format("{:.0f} % of the samples within {:.6g} pN", 100 * within_share, within_pN));
    }
    return unsaid;
}

int feel_command(const FeelOptions& options) {
    std::vector<std::array<double, 2>> ranges_pN;
    for (const std::string& text : options.ranges) {
        ranges_pN.push_back(range_called(text));
        for (const double within_pN :
             options.tolerances_pN) {  // all of it, before anything is played
            (void)read_scene(options.scene, list_settings(options, ranges_pN.back(), within_pN));
        }
    }
    const bool is_watched = isatty(STDERR_FILENO) != 0;
    const std::size_t count = ranges_pN.size() * options.tolerances_pN.size();
    if (!options.json) print_feel_header();
    std::vector<FeelResult> results;
    for (const std::array<double, 2>& range_pN : ranges_pN) {
        for (const double within_pN : options.tolerances_pN) {
            if (is_watched) fmt::print(stderr, "\r{} of {} ", results.size() + 1, count);
            results.push_back(play(options, range_pN, within_pN));
            if (!options.json) print_row(results.back());
        }
    }
    const auto unsaid =
        std::ranges::count_if(results, [](const FeelResult& r) { return !r.unsaid().empty(); });
    if (options.json) {
        nlohmann::ordered_json report{{"count", results.size()}, {"unsaid", unsaid}};
        for (const FeelResult& result : results) report["rows"].push_back(as_json(result));
        fmt::print("{}\n", report.dump(2));
    }
    return unsaid == 0 ? 0 : 1;
}

}  // namespace palpa
