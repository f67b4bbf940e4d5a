#include "tools/bench/answer.h"

#include "core/load_error.h"
#include "core/units.h"
#include "simulation/held.h"
#include "simulation/load.h"
#include "tools/bench/stroke.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

namespace palpa {
namespace {

constexpr double pose_way = 3;         // Å
constexpr double hand_move = 0.1;      // Å
constexpr double truth_stride = 0.02;  // Å, of the hand between two complete relaxations
constexpr double pN = units::piconewton_per_kcal_per_mol_angstrom;
constexpr double least_change_pN = 20;  // errors are relative to no less
constexpr std::array times_ms{0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};

// ---- truth -------------------------------------------------------------------------------------

// Complete relaxation on all pairs, with second derivatives at every end.
class Truth {
public:
    Truth(const TorsionModel& model, const SecondOrder& second) : model_(model) {
        settings_ = second.settings;
        settings_.forces.nonbonded.cutoff = NonbondedSettings{}.cutoff;
        settings_.forces.nonbonded.electrostatics = NonbondedSettings{}.electrostatics;
        settings_.forces.nonbonded.van_der_waals = NonbondedSettings{}.van_der_waals;
        settings_.rest = settings_.relaxed = 1e-3;
        settings_.least_relaxation = 0;
        settings_.most_relaxation = 3000;
        memory_.lineariser = build_lineariser(model, second.statics.renewals.lineariser.held);
        memory_.full = build_quasi_statics(model);
    }

    const HandHold& hand() const { return memory_.lineariser.held.hands.front(); }
    const LinearisedModel& linear() const { return *memory_.last; }
    const SecondOrderSettings& settings() const { return settings_; }

    // The force on the hand at rest, pN, and the state there.
    Vec3 relax(TorsionState& state) {
        const Renewal renewal = make_renewal(model_, settings_, {state, 0, {}, {}}, memory_);
        if (!renewal.linear) throw LoadError({}, "a pose is not finite");
        evaluations_ += renewal.relaxed.evaluations;
        rms_ = renewal.relaxed.rms_force;
        state = renewal.linear->at;
        return pN * force(*renewal.linear);
    }

    // Moves the hand by strides.
    Vec3 follow(TorsionState& state, const Vec3& by, double stride) {
        const auto count = static_cast<int>(std::lround(by.norm() / stride));
        Vec3 found = Vec3::Zero();
        for (int i = 0; i < count; ++i) {
            move(state, by / count);
            found = relax(state);
        }
        return found;
    }

    void move(TorsionState& state, const Vec3& by) const {
        if (hand().spring) {
            state.springs[*hand().spring].place += by;
        } else {
            shift_base(model_, hand().molecule, by, state);
        }
    }

    double rms() const { return rms_; }  // that was left at the last end
    std::size_t evaluations() const { return evaluations_; }

private:
    Vec3 force(const LinearisedModel& linear) const {
        const Eigen::Index turns = hand().turns ? 3 : 0;
        return -linear.gradient.segment<3>(linear.mobile() + turns);
    }

    const TorsionModel& model_;
    SecondOrderSettings settings_;
    RenewalMemory memory_;
    double rms_ = 0;
    std::size_t evaluations_ = 0;
};

struct Move {
    Vec3 by;      // Å
    Vec3 change;  // of the force, pN
    bool is_snap = false;
};

struct AnswerPose {
    TorsionState state;
    std::shared_ptr<const LinearisedModel> linear;
    std::vector<Move> moves;
};

Move find_move(Truth& truth, const TorsionState& pose, const Vec3& at_pose, const Vec3& by) {
    TorsionState state = pose;
    Move move{by, truth.follow(state, by, truth_stride) - at_pose};
    state = pose;
    const Vec3 finer = truth.follow(state, by, truth_stride / 2) - at_pose;
    constexpr double alike = 0.05;
    move.is_snap = (finer - move.change).norm() > alike * std::max(finer.norm(), least_change_pN);
    return move;
}

std::vector<AnswerPose> build_poses(Truth& truth, TorsionState state, int count) {
    std::vector<AnswerPose> poses;
    for (int i = 0; i < count; ++i) {
        if (i > 0) (void)truth.follow(state, {pose_way / count, 0, 0}, truth_stride);
        const Vec3 force = truth.relax(state);
        AnswerPose pose{state, std::make_shared<const LinearisedModel>(truth.linear()), {}};
        for (int axis = 0; axis < 3; ++axis)
            pose.moves.push_back(find_move(truth, state, force, hand_move * Vec3::Unit(axis)));
        say(fmt::format(
            "pose {} of {}: {:.0f} pN, rms {:.1g}, changes of {:.0f}, {:.0f} and {:.0f} "
            "pN{}",
            i + 1, count, force.norm(), truth.rms(), pose.moves[0].change.norm(),
            pose.moves[1].change.norm(), pose.moves[2].change.norm(),
            std::ranges::any_of(pose.moves, &Move::is_snap) ? ", a snap" : ""));
        poses.push_back(std::move(pose));
    }
    return poses;
}

// ---- methods -----------------------------------------------------------------------------------

// After so much time the force had so much error.
struct Answer {
    double us;
    double relative, error_pN;
};
using Answers = std::vector<Answer>;

Answer judge(double us, const Vec3& change, const Move& move) {
    const double error = (change - move.change).norm();
    return {us, error / std::max(move.change.norm(), least_change_pN), error};
}

// Steps of a world until the time is spent; the first one moves the hand.
Answers answer_by_steps(World& world, int settling, const AnswerPose& pose, const Move& move) {
    put(pose.state, world);
    for (int i = 0; i < settling; ++i) (void)relax_step(world);
    const Vec3 before = pN * find_force(world);
    Answers answers;
    for (double us = 0; answers.empty() || us < 1e3 * times_ms.back();) {
        us += 1e6 * seconds_of([&] {
                  if (answers.empty()) move_held(world, move.by);
                  (void)relax_step(world);
              });
        answers.push_back(judge(us, pN * find_force(world) - before, move));
    }
    return answers;
}

// Newton's step by the second derivatives at the pose, then evaluations of the whole energy.
Answers answer_in_full(const TorsionModel& model, const Truth& truth, const AnswerPose& pose,
                       const Move& move) {
    const LinearisedModel& linear = *pose.linear;
    TorsionState state = pose.state;
    QuasiStatics statics = build_quasi_statics(model);
    RelaxSettings settings;
    settings.step.forces = truth.settings().forces;
    settings.force_tolerance = truth.settings().rest;
    settings.precondition = [&](const Coordinates& v) -> Coordinates {
        return find_response(linear.factor, v);
    };
    const HeldInState held{
        truth.hand().molecule,
        truth.hand().spring ? static_cast<std::int32_t>(*truth.hand().spring) : -1};
    const Vec3 before = pN * find_force_on_held(model, state, held);
    const auto begin = std::chrono::steady_clock::now();
    Answers answers;
    Eigen::VectorXd at = Eigen::VectorXd::Zero(linear.coordinates.size());
    at.segment<3>(linear.mobile() + (truth.hand().turns ? 3 : 0)) = move.by;
    at.head(linear.mobile()) = linear.response * at.tail(linear.hands());
    place_about(model, linear.coordinates, linear.at, at, state);
    (void)relax_joints(model, settings, state, statics, [&](const RelaxProgress&) {
        const std::chrono::duration<double, std::micro> us =
            std::chrono::steady_clock::now() - begin;
        answers.push_back(
            judge(us.count(), pN * find_force_on_held(model, state, held) - before, move));
        return us.count() < 1e3 * times_ms.back();
    });
    return answers;
}

struct Method {
    std::string name;
    std::optional<World> world;  // none: in full
    std::size_t step = 0;        // the answer that is one step's
    int settling = 0;            // steps before, since the poses are at rest with all pairs
};

SceneDescription second_order_scene(SceneDescription scene) {
    scene.statics.method = RelaxMethod::SecondOrder;
    return scene;
}

std::vector<Method> build_methods(const BenchStart& start) {
    const auto build = [&](const SceneDescription& scene) {
        return build_mechanics_world(scene, model_of(start.world), held_part(start.world));
    };
    std::vector<Method> methods;
    methods.push_back({"default", build(start.scene)});
    for (const double reach : {4.0, 6.0, 10.0}) {
        SceneDescription scene = second_order_scene(start.scene);
        scene.statics.near_angstrom = reach;
        methods.push_back({fmt::format("near={}", reach), build(scene)});
    }
    SceneDescription cutoff = second_order_scene(start.scene);
    cutoff.statics.cutoff_angstrom = 12;
    methods.push_back({"near=6/cutoff=12", build(cutoff), 0, 40});
    methods.push_back({"full-second-order", {}, 2});
    SceneDescription bfgs = start.scene;
    bfgs.statics.method = RelaxMethod::InverseMass;
    bfgs.statics.steps = 1;
    methods.push_back({"bfgs", build(bfgs)});
    const auto add_paper = [&](std::string name, std::size_t active, std::optional<double> reach) {
        methods.push_back(
            {std::move(name), build_variant(start, {active, reach, JointWeights::Acceleration,
                                                    PairPrecision::Fast})});
    };
    add_paper("paper-40", 40, {});
    add_paper("paper-all", everything, {});
    add_paper("paper-all/cutoff=12", everything, 12);
    return methods;
}

// ---- rows --------------------------------------------------------------------------------------

struct Errors {
    std::vector<double> relative, in_pN;

    void add(const Answer& answer) {
        relative.push_back(answer.relative);
        in_pN.push_back(answer.error_pN);
    }
};

void add_errors(const Errors& errors, std::size_t snaps, double A_f, BenchRow& row) {
    const double newton_per_pN = 1e-12 * A_f;
    row.error = quantile(errors.in_pN, 0.5);
    row.error_unit = "pN";
    row.reference = fmt::format("complete relaxation; {} snaps left out", snaps);
    row.more = {{"error_median", quantile(errors.relative, 0.5)},
                {"error_90", quantile(errors.relative, 0.9)},
                {"error_90_pN", quantile(errors.in_pN, 0.9)},
                {"error_median_N", newton_per_pN * quantile(errors.in_pN, 0.5)},
                {"error_90_N", newton_per_pN * quantile(errors.in_pN, 0.9)}};
}

// The last answer that was there in time; nothing but the frozen change before the first.
std::optional<Answer> answer_after(const Answers& answers, double ms) {
    std::optional<Answer> last;
    for (const Answer& answer : answers) {
        if (answer.us <= 1e3 * ms) last = answer;
    }
    return last;
}

void bench_one(const std::string& name, Method& method, const TorsionModel& model,
               const Truth& truth, std::span<const AnswerPose> poses, double A_f,
               std::vector<BenchRow>& rows, std::string& table) {
    say(fmt::format("{}", name));
    BenchRow row{name, {}, "us"};
    Errors of_step;
    std::array<Errors, times_ms.size()> in_time;
    std::size_t snaps = 0, moves = 0;
    for (const AnswerPose& pose : poses) {
        for (const Move& move : pose.moves) {
            if (move.is_snap) {
                ++snaps;
                continue;
            }
            ++moves;
            const Answers answers =
                method.world ? answer_by_steps(*method.world, method.settling, pose, move)
                             : answer_in_full(model, truth, pose, move);
            const Answer& step = answers[std::min(method.step, answers.size() - 1)];
            row.samples.push_back(step.us);
            of_step.add(step);
            for (std::size_t t = 0; t < times_ms.size(); ++t) {
                if (const auto answer = answer_after(answers, times_ms[t])) in_time[t].add(*answer);
            }
        }
    }
    if (moves == 0) return;
    add_errors(of_step, snaps, A_f, row);
    table +=
        fmt::format("| {} | {:.2f} | {:.1f} | {:.1f} | {:.1f} |", name.substr(name.rfind('/') + 1),
                    1e-3 * quantile(row.samples, 0.5), 100 * quantile(of_step.relative, 0.5),
                    100 * quantile(of_step.relative, 0.9), quantile(of_step.in_pN, 0.5));
    rows.push_back(std::move(row));
    for (std::size_t t = 0; t < times_ms.size(); ++t) {
        // Where half of the moves have no answer yet there is none.
        if (2 * in_time[t].relative.size() < moves) {
            table += " |";
            continue;
        }
        BenchRow at{fmt::format("{}/ms={}", name, times_ms[t]), {times_ms[t]}, "ms"};
        add_errors(in_time[t], snaps, A_f, at);
        rows.push_back(std::move(at));
        table += fmt::format(" {:.1f} |", 100 * quantile(in_time[t].relative, 0.5));
    }
    table += "\n";
}

// ---- ways --------------------------------------------------------------------------------------

struct Way {
    std::string name;
    Vec3 direction;
};

// Each 0.1 Å along a way, what the steps felt and what complete relaxation of their state gives.
struct WayErrors {
    std::vector<double> relative, squares, force_squares;
};

void bench_way(const std::string& name, const Way& way, const BenchStart& start,
               const TorsionState& rest, Truth& truth, World& world, WayErrors& all,
               std::vector<BenchRow>& rows) {
    constexpr double step = 0.02, spacing = 0.1;  // Å
    put(rest, world);
    double seconds = 0;
    std::size_t renewals = 0, snaps = 0;
    WayErrors own;
    for (int i = 1; i <= std::lround(pose_way / step); ++i) {
        RelaxStepReport report;
        seconds += seconds_of([&] {
            move_held(world, step * way.direction);
            report = relax_step(world);
        });
        renewals += report.is_renewed ? 1 : 0;
        snaps += report.released > 1 ? 1 : 0;
        if (i % std::lround(spacing / step) != 0) continue;
        TorsionState state = world.resource<TorsionState>();
        const Vec3 felt = pN * find_force(world), expected = truth.relax(state);
        own.relative.push_back((felt - expected).norm() /
                               std::max(expected.norm(), least_change_pN));
        own.squares.push_back((felt - expected).squaredNorm());
        own.force_squares.push_back(expected.squaredNorm());
    }
    const auto rms = [](const WayErrors& errors) {
        return std::sqrt(mean_of(errors.squares) / mean_of(errors.force_squares));
    };
    BenchRow row{fmt::format("{}/{}", name, way.name), {1e3 * seconds}, "ms"};
    row.more = {{"error_median", quantile(own.relative, 0.5)},
                {"error_90", quantile(own.relative, 0.9)},
                {"error_rms", rms(own)}};
    row.reference =
        fmt::format("{} renewals, {} with more than 1 kcal/mol set free", renewals, snaps);
    say(fmt::format("{}: median {:.2f} %, 90 % {:.2f} %, rms {:.2f} %, {:.2f} s, {}", row.name,
                    100 * row.more[0].second, 100 * row.more[1].second, 100 * row.more[2].second,
                    seconds, row.reference));
    (void)start;
    rows.push_back(std::move(row));
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(all.relative, own.relative);
    append(all.squares, own.squares);
    append(all.force_squares, own.force_squares);
}

void bench_ways(const std::string& name, const BenchStart& start, const TorsionState& rest,
                Truth& truth, std::vector<BenchRow>& rows) {
    World world = build_mechanics_world(start.scene, model_of(start.world), held_part(start.world));
    WayErrors all;
    BenchRow whole{name, {}, "ms"};
    const std::size_t first = rows.size();
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            const Way way{fmt::format("{}{}", sign > 0 ? '+' : '-', "xyz"[axis]),
                          sign * Vec3::Unit(axis)};
            bench_way(name, way, start, rest, truth, world, all, rows);
        }
    }
    for (std::size_t i = first; i < rows.size(); ++i)
        whole.samples.push_back(rows[i].samples.front());
    whole.more = {{"error_median", quantile(all.relative, 0.5)},
                  {"error_90", quantile(all.relative, 0.9)},
                  {"error_rms", std::sqrt(mean_of(all.squares) / mean_of(all.force_squares))}};
    whole.reference = "complete relaxation of the state, each 0.1 A";
    rows.push_back(std::move(whole));
}

}  // namespace

std::string bench_answer(const std::string& scene_name, const SceneDescription& scene,
                         const AnswerBenchSettings& settings, std::vector<BenchRow>& rows) {
    const Connectivity connectivity = load_system(scene).connectivity;
    const BenchStart start = load_start(scene, connectivity);
    const TorsionModel& model = model_of(start.world);
    const World second =
        build_mechanics_world(second_order_scene(scene), model, held_part(start.world));
    Truth truth(model, second.resource<SecondOrder>());
    TorsionState rest = start.world.resource<TorsionState>();
    (void)truth.relax(rest);
    const std::string name = "answer/" + scene_name;
    std::string table = "| method | step, ms | median, % | 90 %, % | median, pN |";
    for (const double ms : times_ms) table += fmt::format(" {} ms |", ms);
    table += "\n| --- | --- | --- | --- | --- |";
    for (std::size_t t = 0; t < times_ms.size(); ++t) table += " --- |";
    table += "\n";
    if (settings.poses > 0) {
        const std::vector<AnswerPose> poses = build_poses(truth, rest, settings.poses);
        for (Method& method : build_methods(start)) {
            bench_one(name + "/" + method.name, method, model, truth, poses, scene.coupling.A_f,
                      rows, table);
        }
    }
    if (!settings.no_ways) bench_ways(name + "/way", start, rest, truth, rows);
    return table;
}

}  // namespace palpa
