#include "tools/lab/bench/stroke.h"

#include "assembly/joints.h"
#include "core/load_error.h"
#include "core/units.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/solver.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpa {
namespace {

constexpr double stride = 0.005;  // Å, of the hand along the stroke

std::size_t count_backbone(const BenchStart& start, const World& world) {
    const PaperStep* const paper = find_solver<PaperStep>(world);
    const TorsionBodies& bodies = model_of(world).tree.bodies;
    std::size_t count = 0;
    for (std::size_t b = 0; b < bodies.bodies.size(); ++b) {
        if (bodies.is_base(b) || !is_backbone(start.connectivity, bodies.bodies[b].axis)) continue;
        if (!paper || paper->statics.selection.is_active[b] != 0) ++count;
    }
    return count;
}

std::string describe_stroke(const StrokeResult& stroke, double all_us) {
    std::string text = fmt::format("mean {:.0f} us with choices", stroke.mean_us());
    if (all_us > 0) text += fmt::format(", {:.3f} of all joints'", stroke.mean_us() / all_us);
    if (!stroke.choice_us.empty())
        text += fmt::format(", choice {:.0f} us", quantile(stroke.choice_us, 0.5));
    return text + fmt::format(
                      ", {} renewals, {:.0f} active, {:.1f} of them backbone, {:.3g} of "
                      "the metric neglected",
                      stroke.renewals, mean_of(stroke.active), mean_of(stroke.backbone),
                      mean_of(stroke.neglected));
}

}  // namespace

void say(const std::string& what) { fmt::print(stderr, "{}\n", what); }

SceneDescription scene_with(SceneDescription scene, const Variant& v) {
    StaticsDescription& statics = scene.statics;
    statics.method = RelaxMethod::QuasiStatic;
    statics.budget_us.reset();
    statics.active =
        v.active == everything ? StaticsDescription{}.active : static_cast<std::int64_t>(v.active);
    statics.cutoff_angstrom = v.cutoff;
    statics.weights = v.weights;
    statics.pairs = v.pairs;
    return scene;
}

BenchStart load_start(const SceneDescription& scene, const Connectivity& connectivity) {
    World world = load_world(scene);
    if (!has_mobile(world)) {
        throw LoadError({scene.file.string()},
                        "no molecule of this scene moves by itself; expected a flexible scene such "
                        "as scenes/hiv/flexible.toml");
    }
    return {scene, connectivity, std::move(world)};
}

World build_variant(const BenchStart& start, const Variant& variant) {
    return build_mechanics_world(scene_with(start.scene, variant), model_of(start.world),
                                 held_part(start.world));
}

double relax(const BenchStart& start, RelaxMethod method, std::size_t steps, World& world) {
    RelaxSettings settings;
    settings.method = method;
    settings.step.forces = build_step_settings(world).forces;
    settings.force_tolerance = start.scene.statics.rest_kcal_per_mol;
    settings.steps = steps;
    QuasiStatics statics = build_quasi_statics(model_of(world));
    const JointRelaxReport report =
        relax_joints(model_of(world), settings, world.write<TorsionState>(), statics);
    start_solver(world);
    return report.rms_force;
}

void put(const TorsionState& state, World& world) { put_state(world, state); }

Vec3 find_force(const World& world) {
    const Entity hand = hand_at(world, 0);
    return spring_of(world, hand) ? find_force_on_held(world, hand)
                                  : Vec3(find_pull_on_held(world, hand).tail<3>());
}

double find_reach(const SceneDescription& scene) {
    double farthest = 0;
    const bool leads = scene.hands.front().stroke == Stroke::Lead;
    if (leads || scene.hands.front().stroke == Stroke::Path) {
        for (const PathPoint& point : scene.hands.front().path) {
            const double away = point.place[0] - scene.hands.front().path.front().place[0];
            if (std::abs(away) > std::abs(farthest)) farthest = away;
        }
    }
    if (farthest == 0) return 3;
    if (leads) return farthest;
    return farthest * 1e-3 / coupling_of(scene, 0).A_d * units::angstrom_per_metre;
}

double StrokeResult::mean_us() const {
    std::vector<double> all = ordinary_us;
    all.insert(all.end(), choice_us.begin(), choice_us.end());
    return mean_of(all);
}

StrokeResult play_stroke(const BenchStart& start, int moves, World& world) {
    const double step = std::copysign(stride, find_reach(start.scene));
    StrokeResult result;
    for (int i = 0; i < moves; ++i) {
        RelaxStepReport report;
        const double us = 1e6 * seconds_of([&] {
                              move_held(world, {i < moves / 2 ? step : -step, 0, 0});
                              report = relax_mobile(world, {}).value();
                          });
        if (report.is_renewed) ++result.renewals;
        const bool is_ordinary = !report.is_chosen && !report.is_renewed;
        (is_ordinary ? result.ordinary_us : result.choice_us).push_back(us);
        result.forces.push_back(find_force(world));
        if (!report.is_chosen && i > 0) continue;
        result.neglected.push_back(report.total > 0 ? report.neglected / report.total : 0);
        result.active.push_back(static_cast<double>(report.active));
        result.backbone.push_back(static_cast<double>(count_backbone(start, world)));
    }
    return result;
}

StrokeResult time_stroke(const BenchStart& start, const TorsionState& from, int moves,
                         World& world) {
    put(from, world);
    StrokeResult result = play_stroke(start, moves, world);
    put(from, world);
    const StrokeResult again = play_stroke(start, moves, world);
    const auto keep_less = [](std::vector<double>& values, const std::vector<double>& others) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::min(values[i], others[i]);
    };
    keep_less(result.ordinary_us, again.ordinary_us);
    keep_less(result.choice_us, again.choice_us);
    return result;
}

void add_time_rows(const std::string& name, const StrokeResult& stroke, double all_us,
                   std::vector<BenchRow>& rows) {
    rows.push_back({name, stroke.ordinary_us, "us", {}, "", describe_stroke(stroke, all_us)});
    if (!stroke.choice_us.empty()) rows.push_back({name + "/choice", stroke.choice_us, "us"});
}

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(1, values.size()));
}

Relation relate(std::span<const std::array<double, 2>> points) {
    std::vector<std::array<double, 2>> logs;
    for (const auto& [x, y] : points) {
        if (x > 0 && y > 0) logs.push_back({std::log(x), std::log(y)});
    }
    double x_mean = 0, y_mean = 0, xx = 0, xy = 0, yy = 0;
    for (const auto& [x, y] : logs) {
        x_mean += x / static_cast<double>(logs.size());
        y_mean += y / static_cast<double>(logs.size());
    }
    for (const auto& [x, y] : logs) {
        xx += (x - x_mean) * (x - x_mean);
        xy += (x - x_mean) * (y - y_mean);
        yy += (y - y_mean) * (y - y_mean);
    }
    if (!(xx > 0 && yy > 0)) return {0, 0, logs.size()};
    return {xy / xx, xy / std::sqrt(xx * yy), logs.size()};
}

}  // namespace palpa
