#include "tools/lab/bench/answer.h"

#include "haptics/gains.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "tools/lab/bench/real_time_way.h"
#include "tools/lab/bench/stroke.h"
#include "tools/lab/bench/truth.h"
#include "tools/lab/experiments/rest_poses.h"

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

constexpr std::array times_ms{0.2, 0.3,  0.5,  0.7,  1.0,  1.5,  2.0,  3.0,  5.0,
                              7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 70.0, 100.0};
constexpr std::array table_times_ms{0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};

// ---- methods -----------------------------------------------------------------------------------

// Of the force, after so much time.
struct Change {
    double us;
    Vec3 change_pN;
};
using Changes = std::vector<Change>;

// Steps of a world until the time is spent; the first one moves the hand.
Changes change_by_steps(World& world, const TorsionState& pose, const Vec3& by) {
    put(pose, world);
    const Vec3 before = pN * find_force(world);
    Changes changes;
    for (double us = 0; changes.empty() || us < 1e3 * times_ms.back();) {
        us += 1e6 * seconds_of([&] {
                  if (changes.empty()) move_held(world, by);
                  (void)relax_mobile(world, {}).value();
              });
        changes.push_back({us, pN * find_force(world) - before});
    }
    return changes;
}

// Newton's step by the second derivatives at the pose, then evaluations of the whole energy.
Changes change_in_full(const TorsionModel& model, const Truth& truth, const RestStart& pose,
                       const Vec3& by) {
    const LinearisedModel& linear = *pose.linear;
    TorsionState state = pose.state;
    QuasiStatics statics = build_quasi_statics(model);
    RelaxSettings settings;
    settings.step.forces = truth.settings().forces;
    settings.force_tolerance = truth.settings().rest;
    settings.precondition = [&](const Coordinates& v) -> Coordinates {
        return find_response(linear.factor, v);
    };
    const std::optional<std::size_t> spring = truth.hand().spring;
    const HeldInState held{truth.hand().molecule, spring ? static_cast<std::int32_t>(*spring) : -1};
    const Vec3 before = pN * find_force_on_held(model, state, held);
    const auto begin = std::chrono::steady_clock::now();
    Changes changes;
    Eigen::VectorXd at = Eigen::VectorXd::Zero(linear.coordinates.size());
    at.segment<3>(linear.mobile() + (truth.hand().turns ? 3 : 0)) = by;
    at.head(linear.mobile()) = linear.response * at.tail(linear.hands());
    place_about(model, linear.coordinates, linear.at, at, state);
    const auto add_change = [&] {
        const std::chrono::duration<double, std::micro> us =
            std::chrono::steady_clock::now() - begin;
        changes.push_back({us.count(), pN * find_force_on_held(model, state, held) - before});
        return us.count() < 1e3 * times_ms.back();
    };
    (void)relax_joints(model, settings, state, statics,
                       [&](const RelaxProgress&) { return add_change(); });
    if (changes.empty()) (void)add_change();  // it was at rest there
    return changes;
}

struct Method {
    std::string name;
    std::optional<World> world;  // none: in full
    std::size_t step = 0;        // the change that is one step's
    bool has_cutoff = false;     // begins at rest with that, and is judged by it, too
};

std::vector<Method> build_methods(const BenchStart& start, std::optional<double> cutoff) {
    const auto build = [&](const SceneDescription& scene) {
        return build_mechanics_world(scene, model_of(start.world), held_part(start.world));
    };
    const auto near = [&](std::optional<double> pairs_end) {
        SceneDescription scene = with_cutoff(second_order_scene(start.scene), pairs_end);
        scene.statics.near_angstrom = 6;
        return build(scene);
    };
    const auto paper = [&](std::size_t active, std::optional<double> pairs_end) {
        return build_variant(start,
                             {active, pairs_end, JointWeights::Acceleration, PairPrecision::Fast});
    };
    const std::string with = cutoff ? fmt::format("/cutoff={}", *cutoff) : "";
    std::vector<Method> methods;
    methods.push_back(
        {"default", build(start.scene), 0, start.scene.statics.cutoff_angstrom.has_value()});
    methods.push_back({"near=6", near({})});
    if (cutoff) methods.push_back({"near=6" + with, near(cutoff), 0, true});
    methods.push_back({"full-second-order", {}, 2});
    methods.push_back({"paper-40", paper(40, {})});
    methods.push_back({"paper-all", paper(everything, {})});
    if (cutoff) methods.push_back({"paper-all" + with, paper(everything, cutoff), 0, true});
    return methods;
}

// ---- curves ------------------------------------------------------------------------------------

// Of all moves.
struct Errors {
    std::vector<double> relative, in_pN;

    void add(const Vec3& change_pN, const RestMove& move) {
        const double error = (change_pN - move.change_pN).norm();
        relative.push_back(error / std::max(move.change_pN.norm(), least_change_pN));
        in_pN.push_back(error);
    }

    AnswerErrors summary() const {
        return {quantile(relative, 0.5), quantile(relative, 0.9), quantile(in_pN, 0.5),
                quantile(in_pN, 0.9)};
    }
};

// What a method made of moves, judged by one truth.
struct Judgement {
    std::vector<double> step_us;
    Errors of_step;
    std::array<Errors, times_ms.size()> in_time;
    std::size_t moves = 0, snaps = 0;

    void add(const Changes& changes, std::size_t step, const RestMove& move) {
        if (move.is_snap) {
            ++snaps;
            return;
        }
        ++moves;
        const Change& at_step = changes[std::min(step, changes.size() - 1)];
        step_us.push_back(at_step.us);
        of_step.add(at_step.change_pN, move);
        for (std::size_t t = 0; t < times_ms.size(); ++t) {
            // The last one that was there in time.
            const Change* last = nullptr;
            for (const Change& change : changes) {
                if (change.us <= 1e3 * times_ms[t]) last = &change;
            }
            if (last) in_time[t].add(last->change_pN, move);
        }
    }
};

AnswerCurve curve_of(const std::string& method, const Judgement& judged) {
    AnswerCurve curve{.method = method, .moves = judged.moves, .snaps = judged.snaps};
    if (judged.moves == 0) return curve;
    curve.step_us = judged.step_us;
    curve.of_step = judged.of_step.summary();
    for (std::size_t t = 0; t < times_ms.size(); ++t) {
        // Where half of the moves have no answer yet there is none.
        const Errors& errors = judged.in_time[t];
        if (2 * errors.relative.size() >= judged.moves)
            curve.in_time.push_back({times_ms[t], errors.summary()});
    }
    return curve;
}

void measure(Method& method, const TorsionModel& model, const Truths& truths,
             std::span<const AnswerPose> poses, std::vector<AnswerCurve>& curves) {
    say(method.name);
    Judgement by_all_pairs, by_own;
    for (const AnswerPose& pose : poses) {
        const RestStart& from = method.has_cutoff ? pose.with_cutoff : pose.all_pairs;
        const std::size_t moves = std::min(pose.all_pairs.moves.size(), from.moves.size());
        for (std::size_t i = 0; i < moves; ++i) {
            const RestMove &move = pose.all_pairs.moves[i], &own = from.moves[i];
            if (move.is_snap && own.is_snap) {
                by_all_pairs.add({}, method.step, move);
                by_own.add({}, method.step, own);
                continue;
            }
            const Changes changes = method.world
                                        ? change_by_steps(*method.world, from.state, move.by)
                                        : change_in_full(model, truths.all_pairs, from, move.by);
            by_all_pairs.add(changes, method.step, move);
            by_own.add(changes, method.step, own);
        }
    }
    curves.push_back(curve_of(method.name, by_all_pairs));
    if (method.has_cutoff)
        curves.push_back(curve_of(method.name + std::string(own_cutoff_suffix), by_own));
}

// ---- rows --------------------------------------------------------------------------------------

void add_errors(const AnswerErrors& errors, const AnswerCurve& curve, double newton_per_pN,
                BenchRow& row) {
    row.error = errors.median_pN;
    row.error_unit = "pN";
    row.reference = fmt::format("complete relaxation{}; {} snaps left out",
                                curve.is_own() ? " with the same cutoff" : "", curve.snaps);
    row.more = {{"error_median", errors.median},
                {"error_90", errors.ninety},
                {"error_90_pN", errors.ninety_pN},
                {"error_median_N", newton_per_pN * errors.median_pN},
                {"error_90_N", newton_per_pN * errors.ninety_pN}};
}

void add_rows(const std::string& name, const Answers& answers, std::vector<BenchRow>& rows) {
    for (const AnswerCurve& curve : answers.curves) {
        if (curve.moves == 0) continue;
        const std::string own_name = name + "/" + curve.method;
        BenchRow row{own_name, curve.step_us, "us"};
        add_errors(curve.of_step, curve, answers.newton_per_pN, row);
        rows.push_back(std::move(row));
        for (const AnswerCurve::Point& point : curve.in_time) {
            BenchRow at{fmt::format("{}/ms={}", own_name, point.ms), {point.ms}, "ms"};
            add_errors(point.errors, curve, answers.newton_per_pN, at);
            rows.push_back(std::move(at));
        }
    }
}

// ---- ways --------------------------------------------------------------------------------------

struct Way {
    std::string name;
    Vec3 direction;
};

void bench_way(const std::string& name, const Way& way, const TorsionState& rest, Truth& truth,
               World& world, WayErrors& all, std::vector<BenchRow>& rows) {
    constexpr double step = 0.02, spacing = 0.1;  // Å
    put(rest, world);
    double seconds = 0;
    std::size_t renewals = 0, snaps = 0;
    WayErrors own;
    for (int i = 1; i <= std::lround(way_angstrom / step); ++i) {
        RelaxStepReport report;
        seconds += seconds_of([&] {
            move_held(world, step * way.direction);
            report = relax_mobile(world, {}).value();
        });
        renewals += report.is_renewed ? 1 : 0;
        snaps += report.released > 1 ? 1 : 0;
        if (i % std::lround(spacing / step) != 0) continue;
        TorsionState state = world.resource<TorsionState>();
        own.add(pN * find_force(world), truth.relax(state));
    }
    BenchRow row{fmt::format("{}/{}", name, way.name), {1e3 * seconds}, "ms"};
    add_way_errors(own, row);
    row.reference =
        fmt::format("{} renewals, {} of them released more than 1 kcal/mol", renewals, snaps);
    say(fmt::format("{}: {}, {:.2f} s, {}", row.name, describe(own), seconds, row.reference));
    rows.push_back(std::move(row));
    all.add(own);
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
            bench_way(name, way, rest, truth, world, all, rows);
        }
    }
    for (std::size_t i = first; i < rows.size(); ++i)
        whole.samples.push_back(rows[i].samples.front());
    add_way_errors(all, whole);
    whole.reference = "complete relaxation of the state, each 0.1 A";
    rows.push_back(std::move(whole));
}

// A scene, the truths of it, and its state: as loaded, or completely relaxed where that is needed.
struct AnswerStart {
    explicit AnswerStart(const SceneDescription& scene)
        : connectivity(load_system(scene).connectivity),
          start(load_start(scene, connectivity)),
          truths(build_truths(start)),
          state(start.world.resource<TorsionState>()) {}

    const TorsionState& rest() {
        if (!is_at_rest) (void)truths.all_pairs.relax(state);
        is_at_rest = true;
        return state;
    }

    Connectivity connectivity;
    BenchStart start;
    Truths truths;
    TorsionState state;
    bool is_at_rest = false;
};

std::vector<AnswerPose> list_poses(const AnswerPoseSettings& settings, AnswerStart& at) {
    if (settings.file) {
        return read_poses(*settings.file, at.truths, model_of(at.start.world), at.state,
                          settings.count);
    }
    std::vector<AnswerPose> poses =
        find_poses(at.truths, at.rest(), settings.count.value_or(usual_answer_poses));
    if (settings.save_to) {
        write_text_file(*settings.save_to, format_rest_poses(rest_poses_of(at.truths, poses)),
                        settings.existing);
    }
    return poses;
}

Answers measure_at(AnswerStart& at, const AnswerPoseSettings& settings) {
    const ForceLaw& law = coupling_of(at.start.world, hand_at(at.start.world, 0)).laws.force;
    Answers answers{{}, 1e-12 * force_gain(law, 0), 0};
    if (settings.count == 0) return answers;
    const std::vector<AnswerPose> poses = list_poses(settings, at);
    answers.poses = poses.size();
    for (Method& method : build_methods(at.start, at.truths.cutoff))
        measure(method, model_of(at.start.world), at.truths, poses, answers.curves);
    return answers;
}

}  // namespace

std::string format_markdown(const Answers& answers) {
    std::string table =
        "| method | one step, ms | median, % | nine of ten, % | median, pN | nine of ten, pN | "
        "median, mN at the hand |";
    for (const double ms : table_times_ms) table += fmt::format(" % after {} ms |", ms);
    table += "\n|";
    for (std::size_t column = 0; column < 7 + table_times_ms.size(); ++column) table += " --- |";
    table += "\n";
    for (const AnswerCurve& curve : answers.curves) {
        if (curve.moves == 0) continue;
        const AnswerErrors& e = curve.of_step;
        table += fmt::format("| {} | {:.2f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.3g} |",
                             curve.method, 1e-3 * quantile(curve.step_us, 0.5), 100 * e.median,
                             100 * e.ninety, e.median_pN, e.ninety_pN,
                             1e3 * answers.newton_per_pN * e.median_pN);
        for (const double ms : table_times_ms) {
            const auto point = std::ranges::find(curve.in_time, ms, &AnswerCurve::Point::ms);
            table += point == curve.in_time.end()
                         ? " |"
                         : fmt::format(" {:.1f} |", 100 * point->errors.median);
        }
        table += "\n";
    }
    return table;
}

bool AnswerCurve::is_own() const { return method.ends_with(own_cutoff_suffix); }

Answers measure_answers(const SceneDescription& scene, const AnswerPoseSettings& settings) {
    AnswerStart at(scene);
    return measure_at(at, settings);
}

Answers bench_answer(const std::string& scene_name, const SceneDescription& scene,
                     const AnswerBenchSettings& settings, std::vector<BenchRow>& rows) {
    AnswerStart at(scene);
    const std::string name = "answer/" + scene_name;
    Answers answers = measure_at(at, settings.poses);
    add_rows(name, answers, rows);
    if (!settings.no_ways) {
        bench_ways(name + "/way", at.start, at.rest(), at.truths.all_pairs, rows);
        bench_real_time_way(name + "/real-time", scene, at.truths.all_pairs, rows);
    }
    return answers;
}

}  // namespace palpa
