#include "tools/lab/experiments/accuracy.h"

#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "loading/load.h"
#include "math/quantile.h"
#include "scene/read_scene.h"
#include "session/accuracy_report.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/probe.h"
#include "simulation/solver.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr double most_share = 0.9;  // of samples that have to be within the tolerance

// The field of all pairs in double, where nothing moves by itself.
Vec3 find_rigid_force(const World& world, const MoleculePose& pose) {
    const Entity hand = hand_at(world, 0);
    FieldPoints group = held_points(world, hand);
    const Mat3 turn = pose.orientation.toRotationMatrix();
    std::vector<Vec3> positions;
    const Grip& grip = grip_of(world, hand);
    for (const Vec3& arm : world.find<RigidShape>(grip.molecule)->atoms)
        positions.emplace_back(grip.anchor + pose.place_angstrom + turn * arm);
    group.positions = positions;
    return field_on(world, hand, group).force;
}

// Complete relaxation of all joints on all pairs, whatever was asked.
class RelaxedReference {
public:
    RelaxedReference(SceneDescription scene, const World& world) {
        scene.statics.method.reset();  // by second order, where it is not too large for that
        scene.statics.active = StaticsDescription{}.active;
        scene.statics.steps = 1;
        scene.statics.responses = 0;
        scene.statics.renewal_ms = 0;
        scene.statics.renews_beside = false;
        scene.statics.budget_us.reset();
        scene.statics.cutoff_angstrom.reset();
        coupling_of(scene, 0).feel_within_pN.reset();
        world_ = build_mechanics_world(scene, model_of(world), held_part(world));
    }

    // On what is held (kcal/mol/Å), from where a state is, once that is held at that place (Å):
    // after 200 steps, and how much the last 50 of them still changed.
    struct Found {
        Vec3 force;
        double change;
    };
    Found find_force(const TorsionState& state, const Vec3& held_at) {
        constexpr int steps = 200, last_steps = 50;
        put_state(world_, state);
        move_held(world_, held_at - held_place(world_, hand_at(world_, 0)));
        Vec3 before = Vec3::Zero();
        for (int i = 0; i < steps; ++i) {
            if (i == steps - last_steps) before = find_force_on_held(world_, hand_at(world_, 0));
            (void)relax_mobile(world_, {}).value();
        }
        const Vec3 force = find_force_on_held(world_, hand_at(world_, 0));
        return {force, (force - before).norm()};
    }

private:
    World world_;
};

// Takes every tick of a run, and looks closely at some.
class AccuracyWatch {
public:
    AccuracyWatch(const SceneDescription& scene, const World& world, std::size_t samples,
                  double within_pN)
        : world_(world), samples_(samples), within_pN_(within_pN) {
        ticks_of_run_ = scene.seconds / servo_tick_s;
        if (has_mobile(world)) reference_.emplace(scene, world);
    }

    void add(const ServoTick& tick) {
        largest_hand_N_ = std::max(largest_hand_N_, tick.sent_newton.norm());
        const double next = (static_cast<double>(errors_pN_.size()) + 0.5) * ticks_of_run_ /
                            static_cast<double>(samples_);
        if (errors_pN_.size() < samples_ && static_cast<double>(tick_) >= next)
            errors_pN_.push_back(find_error(tick.contact));
        ++tick_;
    }

    AccuracyResult take() {
        AccuracyResult result;
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
    double find_error(const ContactModel& model) {
        constexpr double newton = units::newton_per_kcal_per_mol_angstrom;
        Vec3 force = Vec3::Zero();
        if (reference_) {
            const auto found = reference_->find_force(
                world_.resource<TorsionState>(),
                grip_of(world_, hand_at(world_, 0)).anchor + model.molecule.place_angstrom);
            force = found.force;
            changes_pN_.push_back(1e12 * newton * found.change);
        } else {
            force = find_rigid_force(world_, model.molecule);
        }
        return 1e12 * (model.force_newton - newton * (model.projector * force)).norm();
    }

    const World& world_;
    std::size_t samples_;
    double within_pN_, ticks_of_run_ = 0, largest_hand_N_ = 0;
    std::optional<RelaxedReference> reference_;
    std::uint64_t tick_ = 0;
    std::vector<double> errors_pN_, changes_pN_;
};

// The options' settings, and what is asked.
std::vector<std::string> list_settings(const AccuracyOptions& options,
                                       const std::array<double, 2>& range_pN, double within_pN) {
    std::vector<std::string> settings = options.settings;
    settings.push_back(fmt::format("coupling.feel_pN=[{}, {}]", format_real(range_pN[0]),
                                   format_real(range_pN[1])));
    settings.push_back(fmt::format("coupling.feel_within_pN={}", format_real(within_pN)));
    return settings;
}

}  // namespace

std::vector<std::string> AccuracyResult::unsaid() const {
    const AccuracyReport feel = summary.accuracy.value_or(AccuracyReport{});
    const UnmetRequirements unmet = find_unmet(feel);
    std::vector<std::string> unsaid;
    const auto [weakest, strongest] = feel.ends_newton;
    if (!(weakest >= PerceptualForceLaw::least_felt && strongest <= PerceptualForceLaw::most_felt))
        unsaid.push_back(fmt::format("the ends are felt as {} and {} N", weakest, strongest));
    constexpr double rounding = 1e-9;
    if (feel.stiffest_share > 1 + rounding)
        unsaid.push_back(fmt::format("{:.3g} of the cap was felt", feel.stiffest_share));
    if (!(within_share >= most_share) && unmet.tolerance.empty()) {
        unsaid.push_back(
            fmt::format("{:.0f} % of the samples within {:.6g} pN", 100 * within_share, within_pN));
    }
    return unsaid;
}

namespace {

void check_moves_itself(const SceneDescription& scene) {
    if (!scene.engine) return;
    throw LoadError(scene.place_of("engine"),
                    "a remote engine computes the forces of this scene, so Palpa cannot state "
                    "their error; expected a scene without [engine]");
}

}  // namespace

void check_accuracy(const AccuracyOptions& options) {
    for (const std::array<double, 2>& range_pN : options.ranges_pN)
        for (const double within_pN : options.tolerances_pN)
            check_moves_itself(
                read_scene(options.scene, list_settings(options, range_pN, within_pN)));
}

AccuracyResult play_accuracy(const AccuracyOptions& options, const std::array<double, 2>& range_pN,
                             double within_pN) {
    const SceneDescription scene =
        read_scene(options.scene, list_settings(options, range_pN, within_pN));
    World world = load_world(scene);
    EmulatedOmni device(build_emulated_omni(scene, world));
    AccuracyWatch watch(scene, world, options.samples, within_pN);
    const Summary summary = run_headless(scene, world, device, {}, nullptr, {}, {},
                                         [&](const ServoTick& tick) { watch.add(tick); });
    AccuracyResult result = watch.take();
    result.range_pN = range_pN;
    result.within_pN = within_pN;
    result.summary = summary;
    return result;
}

}  // namespace palpa
