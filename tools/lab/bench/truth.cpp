#include "tools/lab/bench/truth.h"

#include "core/load_error.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/solver.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

constexpr double move_length = 0.1;    // Å, of the hand at a pose
constexpr double truth_stride = 0.02;  // Å, of the hand between two complete relaxations
constexpr double usual_cutoff = 12;    // Å

RestMove find_rest_move(Truth& truth, const TorsionState& pose, const Vec3& at_pose,
                        const Vec3& by) {
    TorsionState state = pose;
    RestMove move{by, truth.follow(state, by, truth_stride) - at_pose};
    state = pose;
    const Vec3 finer = truth.follow(state, by, truth_stride / 2) - at_pose;
    constexpr double alike = 0.05;
    move.is_snap =
        (finer - move.change_pN).norm() > alike * std::max(finer.norm(), least_change_pN);
    return move;
}

// The state goes to rest, too.
RestStart find_rest_start(Truth& truth, TorsionState& state) {
    const Vec3 force = truth.relax(state);
    RestStart start{state, truth.linear(), {}};
    const double rms = truth.rms();
    std::string changes;
    for (int axis = 0; axis < 3; ++axis) {
        const RestMove move = find_rest_move(truth, state, force, move_length * Vec3::Unit(axis));
        changes += fmt::format("{}{:.0f}{}", axis > 0 ? ", " : "", move.change_pN.norm(),
                               move.is_snap ? " (a snap)" : "");
        start.moves.push_back(move);
    }
    say(fmt::format("  {:.0f} pN, rms {:.1g}, changes of {} pN", force.norm(), rms, changes));
    return start;
}

Vec3 force_of(const HandHold& hand, const LinearisedModel& linear) {
    return -pN * linear.gradient.segment<3>(linear.mobile() + (hand.turns ? 3 : 0));
}

PosedModel posed_model(const Truths& truths, const TorsionState& state) {
    return {state.positions.size(), state.angles.size(), state.turns.size(), state.springs.size(),
            truths.cutoff.value_or(0)};
}

RestPose rest_pose_of(const Truth& truth, const RestStart& start) {
    RestPose pose{.energy = start.state.energy(),
                  .force_pN = force_of(truth.hand(), *start.linear),
                  .angles = start.state.angles,
                  .turns = start.state.turns,
                  .shifts = start.state.shifts,
                  .springs = {},
                  .moves = start.moves};
    for (const ModelSpring& spring : start.state.springs) pose.springs.push_back(spring.place);
    return pose;
}

// Single precision, and what a file leaves out, make less of a difference.
constexpr double same_energy = 0.02;  // kcal/mol
constexpr double same_force_pN = 2;

RestStart restore_rest(const std::filesystem::path& path, const RestPose& pose, Truth& truth,
                       const TorsionModel& model, TorsionState state) {
    state.angles = pose.angles;
    state.shifts = pose.shifts;
    for (std::size_t i = 0; i < pose.turns.size(); ++i) state.turns[i] = pose.turns[i].normalized();
    for (std::size_t i = 0; i < pose.springs.size(); ++i) state.springs[i].place = pose.springs[i];
    update_positions(model, state);
    update_pivots(model, state);
    const Vec3 force = truth.evaluate(state);
    const double energy_off = state.energy() - pose.energy;
    const double force_off = (force - pose.force_pN).norm();
    if (!(std::abs(energy_off) < same_energy && force_off < same_force_pN)) {
        throw LoadError(
            {path.string(), pose.line},
            fmt::format("energy and force differ by {:.3g} kcal/mol and {:.3g} pN from those of "
                        "the saved pose; expected poses of this scene, made with --save-poses",
                        energy_off, force_off));
    }
    return {std::move(state), truth.linear(), pose.moves};
}

}  // namespace

// ---- truth -------------------------------------------------------------------------------------

Truth::Truth(const TorsionModel& model, const SecondOrder& second)
    : model_(model), settings_(second.settings) {
    settings_.rest = settings_.relaxed = 1e-3;
    settings_.least_relaxation = 0;
    settings_.most_relaxation = 3000;
    settings_.responses.reset();
    memory_.lineariser = build_lineariser(model, second.statics.renewals.lineariser.held);
    memory_.full = build_quasi_statics(model);
}

Vec3 Truth::relax(TorsionState& state) { return renew(settings_, state); }

Vec3 Truth::evaluate(TorsionState& state) {
    SecondOrderSettings as_it_is = settings_;
    as_it_is.most_relaxation = 0;
    return renew(as_it_is, state);
}

Vec3 Truth::renew(const SecondOrderSettings& settings, TorsionState& state) {
    const Renewal renewal = make_renewal(model_, settings, {state, 0, 0, {}, {}, {}, {}}, memory_);
    if (!renewal.linear) throw LoadError({}, "a pose has coordinates that are not finite");
    rms_ = renewal.relaxed.rms_force;
    state = renewal.linear->at;
    return force_of(hand(), *renewal.linear);
}

Vec3 Truth::follow(TorsionState& state, const Vec3& by, double stride) {
    const auto count = static_cast<int>(std::lround(by.norm() / stride));
    Vec3 found = Vec3::Zero();
    for (int i = 0; i < count; ++i) {
        move(state, by / count);
        found = relax(state);
    }
    return found;
}

void Truth::move(TorsionState& state, const Vec3& by) const {
    if (const std::optional<std::size_t> spring = hand().spring) {
        state.springs[*spring].place += by;
    } else {
        shift_base(model_, hand().molecule, by, state);
    }
}

SceneDescription second_order_scene(SceneDescription scene) {
    scene.statics.method = RelaxMethod::SecondOrder;
    return scene;
}

SceneDescription with_cutoff(SceneDescription scene, std::optional<double> cutoff) {
    scene.statics.cutoff_angstrom = cutoff;
    return scene;
}

Truths build_truths(const BenchStart& start) {
    const TorsionModel& model = model_of(start.world);
    const SceneDescription scene = second_order_scene(start.scene);
    std::optional<double> cutoff;
    if (scene.force_field.solvent == Solvent::None)
        cutoff = scene.statics.cutoff_angstrom.value_or(usual_cutoff);
    const auto build = [&](std::optional<double> pairs_end) {
        const World world =
            build_mechanics_world(with_cutoff(scene, pairs_end), model, held_part(start.world));
        return Truth(model, *find_solver<SecondOrder>(world));
    };
    return {build({}), build(cutoff), cutoff};
}

// ---- poses -------------------------------------------------------------------------------------

std::vector<AnswerPose> find_poses(Truths& truths, TorsionState state, int count) {
    std::vector<AnswerPose> poses;
    for (int i = 0; i < count; ++i) {
        if (i > 0) (void)truths.all_pairs.follow(state, {way_angstrom / count, 0, 0}, truth_stride);
        const std::string kinds =
            truths.cutoff ? fmt::format(", all pairs and {} Å", *truths.cutoff) : "";
        say(fmt::format("pose {} of {}{}", i + 1, count, kinds));
        AnswerPose pose;
        pose.all_pairs = find_rest_start(truths.all_pairs, state);
        TorsionState other = state;
        pose.with_cutoff =
            truths.cutoff ? find_rest_start(truths.with_cutoff, other) : pose.all_pairs;
        poses.push_back(std::move(pose));
    }
    return poses;
}

RestPoses rest_poses_of(const Truths& truths, const std::vector<AnswerPose>& poses) {
    RestPoses file;
    for (const AnswerPose& pose : poses) {
        file.of = posed_model(truths, pose.all_pairs.state);
        file.poses.push_back({rest_pose_of(truths.all_pairs, pose.all_pairs),
                              rest_pose_of(truths.with_cutoff, pose.with_cutoff)});
    }
    return file;
}

std::vector<AnswerPose> read_poses(const std::filesystem::path& path, Truths& truths,
                                   const TorsionModel& model, const TorsionState& rest,
                                   std::optional<int> most) {
    const RestPoses file = read_rest_poses(path, posed_model(truths, rest));
    const std::size_t count = most ? static_cast<std::size_t>(*most) : file.poses.size();
    if (count > file.poses.size()) {
        throw LoadError({path.string()}, fmt::format("has {} poses; expected --poses {} or less",
                                                     file.poses.size(), file.poses.size()));
    }
    std::vector<AnswerPose> poses;
    for (std::size_t i = 0; i < count; ++i) {
        const RestPosePair& pair = file.poses[i];
        poses.push_back({restore_rest(path, pair.all_pairs, truths.all_pairs, model, rest),
                         restore_rest(path, pair.with_cutoff, truths.with_cutoff, model, rest)});
    }
    return poses;
}

void WayErrors::add(const Vec3& felt_pN, const Vec3& expected_pN) {
    const double error = (felt_pN - expected_pN).norm();
    relative.push_back(error / std::max(expected_pN.norm(), least_change_pN));
    squares.push_back(error * error);
    force_squares.push_back(expected_pN.squaredNorm());
}

void WayErrors::add(const WayErrors& others) {
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(relative, others.relative);
    append(squares, others.squares);
    append(force_squares, others.force_squares);
}

double WayErrors::rms() const { return std::sqrt(mean_of(squares) / mean_of(force_squares)); }

std::string describe(const WayErrors& errors) {
    return fmt::format("median {:.2f} %, 90 % {:.2f} %, rms {:.2f} %",
                       100 * quantile(errors.relative, 0.5), 100 * quantile(errors.relative, 0.9),
                       100 * errors.rms());
}

void add_way_errors(const WayErrors& errors, BenchRow& row) {
    row.more = {{"error_median", quantile(errors.relative, 0.5)},
                {"error_90", quantile(errors.relative, 0.9)},
                {"error_rms", errors.rms()}};
}

}  // namespace palpa
