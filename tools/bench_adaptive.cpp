#include "tools/bench_adaptive.h"

#include "assembly/joints.h"
#include "charmm/cut_sphere.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "simulation/simulation.h"
#include "statics/held_model.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t everything = std::numeric_limits<std::size_t>::max();
constexpr std::array<std::size_t, 8> active_counts{0, 10, 20, 40, 80, 160, 320, everything};
constexpr std::array<std::optional<double>, 2> cutoffs{std::nullopt, 12.0};
constexpr double stride = 0.005;     // Å, of the hand along the stroke
constexpr double local_shift = 0.1;  // Å
constexpr std::size_t local_steps = 300;
constexpr double apart = 0.001;  // Å, of the two runs that make the floor
constexpr double pN = 1e12 * units::newton_per_kcal_per_mol_angstrom;

void say(const std::string& what) { fmt::print(stderr, "{}\n", what); }

// ---- what is compared --------------------------------------------------------------------------

struct Variant {
    std::size_t active;
    std::optional<double> cutoff;
    JointWeights weights;
    PairPrecision pairs;
};

std::string_view weight_name(const Variant& v) {
    return v.active == everything ? "all" : joint_weight_names[static_cast<std::size_t>(v.weights)];
}

std::string active_name(std::size_t active) {
    return active == everything ? "all" : fmt::format("{}", active);
}

std::string cutoff_name(const std::optional<double>& cutoff) {
    return cutoff ? fmt::format("cutoff={}", *cutoff) : "all-pairs";
}

std::string name_of(const Variant& v) {
    const std::string name =
        fmt::format("active={}/{}", active_name(v.active), cutoff_name(v.cutoff));
    return v.active == everything || v.active == 0 ? name
                                                   : fmt::format("{}/{}", name, weight_name(v));
}

SceneDescription scene_with(SceneDescription scene, const Variant& v) {
    StaticsDescription& statics = scene.statics;
    statics.method = StaticsMethod::QuasiStatic;
    statics.budget_us.reset();
    statics.active =
        v.active == everything ? StaticsDescription{}.active : static_cast<std::int64_t>(v.active);
    statics.cutoff_angstrom = v.cutoff;
    statics.weights = v.weights;
    statics.pairs = v.pairs;
    return scene;
}

// A scene that has been loaded.
struct Start {
    const SceneDescription& scene;
    const Connectivity& connectivity;
    Flexible flexible;
};

Flexible build_variant(const Start& start, const Variant& variant) {
    return build_flexible(scene_with(start.scene, variant), start.flexible.model,
                          start.flexible.grabbed, start.flexible.state.tether);
}

void put(const TorsionState& state, Flexible& flexible) {
    flexible.state = state;
    flexible.statics.h = 0;
    flexible.adaptive = {};
    if (flexible.adaptive_settings) flexible.adaptive = build_adaptive_statics(flexible.model);
    start_flexible(flexible);
}

// kcal/mol/Å, on the hand.
Vec3 find_force(const Flexible& flexible) {
    if (!flexible.state.tether) return find_pull_on_held(flexible).tail<3>();
    const Tether& tether = *flexible.state.tether;
    return tether.k *
           (find_tethered(flexible.model, tether, flexible.state.positions) - tether.place);
}

std::size_t count_backbone(const Start& start, const Flexible& flexible) {
    const TorsionBodies& bodies = flexible.model.tree.bodies;
    std::size_t count = 0;
    for (std::size_t b = 0; b < bodies.bodies.size(); ++b) {
        if (bodies.is_base(b) || !is_backbone(start.connectivity, bodies.bodies[b].axis)) continue;
        if (!flexible.adaptive_settings || flexible.adaptive.selection.is_active[b] != 0) ++count;
    }
    return count;
}

// ---- numbers -----------------------------------------------------------------------------------

double mean_of(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(1, values.size()));
}

double rms_of(std::span<const double> values) {
    const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, values.size())));
}

double rms_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]).squaredNorm();
    return std::sqrt(squares / static_cast<double>(a.size()));
}

double rms_norm(std::span<const Vec3> values) {
    std::vector<double> norms;
    for (const Vec3& value : values) norms.push_back(value.norm());
    return rms_of(norms);
}

// Norms of differences, relative to the rms of what is expected.
std::vector<double> relative_errors(std::span<const Vec3> values, std::span<const Vec3> expected) {
    const double rms = std::max(rms_norm(expected), 1e-300);
    std::vector<double> errors;
    for (std::size_t i = 0; i < values.size(); ++i)
        errors.push_back((values[i] - expected[i]).norm() / rms);
    return errors;
}

// Of logarithms, of values above 0.
struct Relation {
    double slope = 0, correlation = 0;
    std::size_t points = 0;
};

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

// ---- the stroke --------------------------------------------------------------------------------

// Å along x, from where the scene's path begins to where it is farthest.
double find_reach(const SceneDescription& scene) {
    double farthest = 0;
    if (scene.hand.stroke == Stroke::Path) {
        for (const auto& [time, place] : scene.hand.path) {
            const double away = place - scene.hand.path.front()[1];
            if (std::abs(away) > std::abs(farthest)) farthest = away;
        }
    }
    if (farthest == 0) return 3;
    return farthest * 1e-3 / scene.coupling.A_d * units::angstrom_per_metre;
}

struct StrokeResult {
    std::vector<double> ordinary_us, choice_us;
    std::vector<double> neglected;  // shares of the metric, at choices
    std::vector<double> active, backbone;
    std::size_t renewals = 0;
    std::vector<Vec3> forces;  // after each move, kcal/mol/Å

    double mean_us() const {
        std::vector<double> all = ordinary_us;
        all.insert(all.end(), choice_us.begin(), choice_us.end());
        return mean_of(all);
    }
};

// Out and back.
StrokeResult play_stroke(const Start& start, int moves, Flexible& flexible) {
    const double step = std::copysign(stride, find_reach(start.scene));
    StrokeResult result;
    for (int i = 0; i < moves; ++i) {
        const std::size_t renewals = flexible.adaptive.renewals;
        SettleReport report;
        const double us = 1e6 * seconds_of([&] {
                              move_held(flexible, {i < moves / 2 ? step : -step, 0, 0});
                              report = step_flexible(flexible);
                          });
        result.renewals += flexible.adaptive.renewals - renewals;
        const bool is_ordinary = !report.is_chosen && flexible.adaptive.renewals == renewals;
        (is_ordinary ? result.ordinary_us : result.choice_us).push_back(us);
        result.forces.push_back(find_force(flexible));
        if (!report.is_chosen && i > 0) continue;
        result.neglected.push_back(report.total > 0 ? report.neglected / report.total : 0);
        result.active.push_back(static_cast<double>(report.active));
        result.backbone.push_back(static_cast<double>(count_backbone(start, flexible)));
    }
    return result;
}

// Twice the same; each move took what it took the faster time.
StrokeResult time_stroke(const Start& start, const TorsionState& from, int moves,
                         Flexible& flexible) {
    put(from, flexible);
    StrokeResult result = play_stroke(start, moves, flexible);
    put(from, flexible);
    const StrokeResult again = play_stroke(start, moves, flexible);
    const auto keep_less = [](std::vector<double>& values, const std::vector<double>& others) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::min(values[i], others[i]);
    };
    keep_less(result.ordinary_us, again.ordinary_us);
    keep_less(result.choice_us, again.choice_us);
    return result;
}

// ---- from rest ---------------------------------------------------------------------------------

struct LocalEnd {
    Vec3 change;  // of the force on the hand, kcal/mol/Å
    std::vector<Vec3> positions;
    double neglected = 0;  // of the metric, at the last choice
};

Vec3 local_move(const Start& start) {
    return {std::copysign(local_shift, find_reach(start.scene)), 0, 0};
}

LocalEnd play_local(const Start& start, const TorsionState& pose, Flexible& flexible) {
    put(pose, flexible);
    const Vec3 before = find_force(flexible);
    move_held(flexible, local_move(start));
    LocalEnd end;
    for (std::size_t i = 0; i < local_steps; i += flexible.settings.steps) {
        end.neglected = step_flexible(flexible).neglected;
    }
    end.change = find_force(flexible) - before;
    end.positions = flexible.state.positions;
    return end;
}

double relax(const Start& start, RelaxMethod method, std::size_t steps, Flexible& flexible) {
    RelaxSettings settings;
    settings.method = method;
    settings.step.forces = flexible.settings.step.forces;
    settings.force_tolerance = start.scene.statics.rest_kcal_per_mol;
    settings.steps = steps;
    return relax_joints(flexible.model, settings, flexible.state, flexible.statics).rms_force;
}

// Most of the way with fast pairs, the end in double. Returns the rms force that is left.
double bring_to_rest(const Start& start, Flexible& fast, Flexible& exact) {
    (void)relax(start, RelaxMethod::InverseMass, 1500, fast);
    (void)relax(start, RelaxMethod::LimitedMemory, 1500, fast);
    put(fast.state, exact);
    return relax(start, RelaxMethod::LimitedMemory, 200, exact);
}

// Where all joints are at rest, and where they go when the hand moves.
struct Pose {
    TorsionState rest;
    double rms_force;
    LocalEnd same_steps, at_rest;
};

std::vector<Pose> build_poses(const Start& start, int count) {
    Flexible guide =
        build_variant(start, {everything, {}, JointWeights::Plain, PairPrecision::Fast});
    Flexible exact =
        build_variant(start, {everything, {}, JointWeights::Plain, PairPrecision::Double});
    put(start.flexible.state, guide);
    const double reach = find_reach(start.scene);
    constexpr double long_stride = 0.05;  // Å
    double gone = 0;
    std::vector<Pose> poses;
    for (int i = 0; i < count; ++i) {
        const double to = reach * i / count;
        while (std::abs(to - gone) > 1e-9) {
            const double step = std::clamp(to - gone, -long_stride, long_stride);
            move_held(guide, {step, 0, 0});
            (void)step_flexible(guide);
            gone += step;
        }
        Pose pose;
        pose.rms_force = bring_to_rest(start, guide, exact);
        pose.rest = exact.state;
        const Vec3 before = find_force(exact);
        pose.same_steps = play_local(start, pose.rest, exact);
        put(pose.rest, guide);
        move_held(guide, local_move(start));
        const double left = bring_to_rest(start, guide, exact);
        put(pose.rest, guide);
        pose.at_rest = {find_force(exact) - before, exact.state.positions};
        say(
            fmt::format("pose {} of {}: {:.2f} Å out, {:.2g} kcal/mol per rad and Å left, {:.2g} "
                        "after the move",
                        i + 1, count, gone, pose.rms_force, left));
        poses.push_back(std::move(pose));
    }
    return poses;
}

// ---- one variant -------------------------------------------------------------------------------

struct Result {
    Variant variant;
    StrokeResult stroke;
    std::vector<double> path, local_force, local_rest, local_position;
    std::vector<std::array<double, 2>> neglected_force, neglected_position;
};

struct References {
    std::vector<Pose> poses;
    std::vector<Vec3> path;  // forces along the stroke
};

std::vector<Vec3> changes_of(std::span<const Pose> poses, LocalEnd Pose::* end) {
    std::vector<Vec3> changes;
    for (const Pose& pose : poses) changes.push_back((pose.*end).change);
    return changes;
}

Result run_variant(const Start& start, const References& references, const Variant& variant) {
    Result result{variant, {}, {}, {}, {}, {}, {}, {}};
    Flexible flexible = build_variant(start, variant);
    std::vector<Vec3> changes;
    std::vector<double> neglected;
    for (const Pose& pose : references.poses) {
        const LocalEnd end = play_local(start, pose.rest, flexible);
        changes.push_back(end.change);
        neglected.push_back(end.neglected);
        result.local_position.push_back(rms_distance(end.positions, pose.same_steps.positions));
    }
    result.local_force = relative_errors(changes, changes_of(references.poses, &Pose::same_steps));
    result.local_rest = relative_errors(changes, changes_of(references.poses, &Pose::at_rest));
    for (std::size_t i = 0; i < neglected.size(); ++i) {
        result.neglected_force.push_back({neglected[i], result.local_force[i]});
        result.neglected_position.push_back({neglected[i], result.local_position[i]});
    }
    result.stroke = time_stroke(start, references.poses.front().rest,
                                static_cast<int>(references.path.size()), flexible);
    result.path = relative_errors(result.stroke.forces, references.path);
    return result;
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

void add_time_rows(const std::string& name, const StrokeResult& stroke, double all_us,
                   std::vector<BenchRow>& rows) {
    rows.push_back({name, stroke.ordinary_us, "us", {}, "", describe_stroke(stroke, all_us)});
    if (!stroke.choice_us.empty()) rows.push_back({name + "/choice", stroke.choice_us, "us"});
}

void add_rows(const std::string& name, const Result& result, const References& references,
              double all_us, std::vector<BenchRow>& rows) {
    constexpr std::string_view exact = "all joints, all pairs, double";
    add_time_rows(name, result.stroke, all_us, rows);
    const auto add = [&](std::string_view what, const std::vector<double>& samples, double scale,
                         std::string_view unit, std::string_view against) {
        rows.push_back({fmt::format("{}/{}", name, what), samples,
                        unit == "pN" ? "relative" : std::string(unit), scale * rms_of(samples),
                        std::string(unit), std::string(against)});
    };
    const std::vector<Vec3> same = changes_of(references.poses, &Pose::same_steps);
    const std::vector<Vec3> rest = changes_of(references.poses, &Pose::at_rest);
    add("local-force", result.local_force, pN * rms_norm(same), "pN",
        fmt::format("{}, as many steps: {:.0f} pN", exact, pN * rms_norm(same)));
    add("local-rest", result.local_rest, pN * rms_norm(rest), "pN",
        fmt::format("{}, at rest: {:.0f} pN", exact, pN * rms_norm(rest)));
    add("local-position", result.local_position, 1, "A", exact);
    add("path", result.path, pN * rms_norm(references.path), "pN",
        fmt::format("{}: {:.0f} pN", exact, pN * rms_norm(references.path)));
}

std::string table_line(const Result& result, double all_us) {
    const Variant& v = result.variant;
    const StrokeResult& s = result.stroke;
    return fmt::format(
        "| {} | {} | {} | {:.0f} | {:.0f} to {:.0f} | {} | {:.0f} | {:.3f} | {:.1f} | {:.1f} | "
        "{:.1f} | "
        "{:.1f} | {:.4f} | {:.1f} |\n",
        active_name(v.active), v.cutoff ? "12 Å" : "all", v.active == 0 ? "" : weight_name(v),
        quantile(s.ordinary_us, 0.5), quantile(s.ordinary_us, 0.1), quantile(s.ordinary_us, 0.9),
        s.choice_us.empty() ? "" : fmt::format("{:.0f}", quantile(s.choice_us, 0.5)), s.mean_us(),
        s.mean_us() / all_us, mean_of(s.backbone), 100 * mean_of(s.neglected),
        100 * rms_of(result.local_force), 100 * rms_of(result.local_rest),
        rms_of(result.local_position), 100 * rms_of(result.path));
}

constexpr std::string_view table_head =
    "| active | pairs | weights | step, µs | 10 to 90 % | choice | mean | of all joints' | "
    "backbone "
    "| neglected, % | force, % | at rest, % | position, Å | stroke, % |\n"
    "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";

std::vector<Variant> list_variants(const Start& start, const std::optional<double>& cutoff) {
    std::vector<Variant> variants;
    const PairPrecision pairs = start.scene.statics.pairs;
    variants.push_back({everything, cutoff, JointWeights::Plain, pairs});
    for (const std::size_t active : active_counts) {
        if (active >= static_cast<std::size_t>(start.flexible.model.coordinates)) continue;
        for (std::size_t w = 0; w < joint_weight_names.size(); ++w) {
            if (active == 0 && w > 0) continue;
            variants.push_back({active, cutoff, static_cast<JointWeights>(w), pairs});
        }
    }
    return variants;
}

void add_relations(const std::string& prefix, std::span<const Result> results,
                   std::vector<BenchRow>& rows) {
    for (std::size_t w = 0; w < joint_weight_names.size(); ++w) {
        std::vector<std::array<double, 2>> force, position, time;
        std::optional<double> cutoff;
        for (const Result& result : results) {
            const Variant& v = result.variant;
            if (v.active == 0 || v.active == everything || static_cast<std::size_t>(v.weights) != w)
                continue;
            cutoff = v.cutoff;
            std::ranges::copy(result.neglected_force, std::back_inserter(force));
            std::ranges::copy(result.neglected_position, std::back_inserter(position));
            time.push_back(
                {static_cast<double>(v.active), quantile(result.stroke.ordinary_us, 0.5)});
        }
        if (time.size() < 2) continue;
        const std::string what = fmt::format("{}/{}", cutoff_name(cutoff), joint_weight_names[w]);
        const auto add = [&](std::string_view of,
                             const std::vector<std::array<double, 2>>& points) {
            const Relation relation = relate(points);
            rows.push_back(
                {fmt::format("{}/relation/{}/{}", prefix, what, of),
                 {relation.correlation},
                 "correlation",
                 {},
                 "",
                 fmt::format("{} points, slope {:.2f}", relation.points, relation.slope)});
        };
        add("force", force);
        add("position", position);
        rows.push_back({fmt::format("{}/exponent-of-active/{}", prefix, what),
                        {relate(time).slope},
                        "exponent"});
    }
}

Start load_start(const SceneDescription& scene, const Connectivity& connectivity) {
    Simulation simulation = load_simulation(scene);
    if (!simulation.flexible) {
        throw LoadError({scene.file.string()},
                        "nothing moves by itself here; expected a flexible scene, as "
                        "scenes/hiv/flexible.toml");
    }
    return {scene, connectivity, std::move(*simulation.flexible)};
}

// ---- spheres -----------------------------------------------------------------------------------

constexpr std::array<std::size_t, 5> sphere_sizes{1'000, 3'000, 10'000, 30'000, 100'000};
constexpr std::size_t sphere_of_counts = 30'000, sphere_active = 40;

bool is_residue(const AtomName& name, const AtomName& other) {
    return name.segment == other.segment && name.number == other.number;
}

// The first atom of what the hand's spring holds; the molecule in hand is the first of the table.
std::uint32_t find_centre(const SceneDescription& scene, const Connectivity& connectivity) {
    const std::vector<std::string_view> words = split_words(scene.grab.atom);
    if (!words.empty()) {
        for (std::uint32_t i = 0; i < connectivity.names.size(); ++i) {
            if (connectivity.names[i].number == words.front()) return i;
        }
    }
    throw LoadError(scene.place_of("grab.atom"),
                    "expected a residue in the hand, to cut spheres around");
}

// A sphere with its middle residue on the hand's spring.
Flexible build_sphere(const SceneDescription& scene, const CutSystem& sphere,
                      const AtomName& middle) {
    Tether tether;
    tether.k = scene.grab.spring_kcal_per_mol_angstrom2;
    for (std::uint32_t i = 0; i < sphere.connectivity.names.size(); ++i) {
        if (is_residue(sphere.connectivity.names[i], middle)) tether.atoms.push_back(i);
    }
    TorsionModel model = build_held_model(sphere.connectivity, sphere.topology, sphere.positions);
    const std::uint32_t body = model.tree.bodies.body_of[tether.atoms.front()];
    const std::uint32_t grabbed = model.tree.molecule_of[body];
    const Variant variant{0, 12.0, JointWeights::Light, PairPrecision::Fast};
    return build_flexible(scene_with(scene, variant), std::move(model), grabbed, std::move(tether));
}

StrokeResult time_sphere(const Start& start, std::size_t active, int moves) {
    Flexible flexible = start.flexible;
    if (flexible.adaptive_settings) flexible.adaptive_settings->limits.degrees_of_freedom = active;
    return time_stroke(start, start.flexible.state, moves, flexible);
}

constexpr std::string_view sphere_table_head =
    "| atoms | joints | active | backbone | step, µs | 10 to 90 % | choice | mean |\n"
    "| --- | --- | --- | --- | --- | --- | --- | --- |\n";

std::string sphere_line(std::size_t atoms, std::size_t joints, std::size_t active,
                        const StrokeResult& s) {
    return fmt::format("| {} | {} | {} | {:.1f} | {:.0f} | {:.0f} to {:.0f} | {:.0f} | {:.0f} |\n",
                       atoms, joints, active, mean_of(s.backbone), quantile(s.ordinary_us, 0.5),
                       quantile(s.ordinary_us, 0.1), quantile(s.ordinary_us, 0.9),
                       quantile(s.choice_us, 0.5), s.mean_us());
}

// Growth of steps, choices and all together.
class Growth {
public:
    void add(double size, const StrokeResult& stroke) {
        steps_.push_back({size, quantile(stroke.ordinary_us, 0.5)});
        choices_.push_back({size, quantile(stroke.choice_us, 0.5)});
        means_.push_back({size, stroke.mean_us()});
    }

    std::string add_rows(const std::string& name, std::vector<BenchRow>& rows) const {
        rows.push_back({name + "/step", {relate(steps_).slope}, "exponent"});
        rows.push_back({name + "/choice", {relate(choices_).slope}, "exponent"});
        rows.push_back({name + "/mean", {relate(means_).slope}, "exponent"});
        return fmt::format("step {:.2f}, choice {:.2f}, mean {:.2f}", relate(steps_).slope,
                           relate(choices_).slope, relate(means_).slope);
    }

private:
    std::vector<std::array<double, 2>> steps_, choices_, means_;
};

}  // namespace

std::string bench_spheres(const std::string& scene_name, const SceneDescription& scene,
                          const AdaptiveBenchSettings& settings, std::vector<BenchRow>& rows) {
    const SceneSystem system = load_system(scene);
    const std::uint32_t centre = find_centre(scene, system.connectivity);
    const std::string prefix = "adaptive/" + scene_name;
    std::string table{sphere_table_head};
    Growth with_atoms, with_active;
    for (const std::size_t most : sphere_sizes) {
        if (most > system.positions.size()) break;
        const CutSystem sphere =
            cut_sphere(system.connectivity, system.topology, system.positions, centre, most);
        const Start start{scene, sphere.connectivity,
                          build_sphere(scene, sphere, system.connectivity.names[centre])};
        for (const std::size_t active : active_counts) {
            const bool is_counted = most == sphere_of_counts && active > 0 && active != everything;
            if (active != sphere_active && !is_counted) continue;
            say(fmt::format("sphere of {} atoms, {} active", sphere.positions.size(), active));
            const StrokeResult stroke = time_sphere(start, active, settings.stroke_moves);
            add_time_rows(
                fmt::format("{}/atoms={}/active={}", prefix, sphere.positions.size(), active),
                stroke, 0, rows);
            table += sphere_line(sphere.positions.size(), start.flexible.joints, active, stroke);
            if (active == sphere_active)
                with_atoms.add(static_cast<double>(sphere.positions.size()), stroke);
            if (is_counted) with_active.add(static_cast<double>(active), stroke);
        }
    }
    table += fmt::format("\nExponents of growth with atoms: {}; with active joints: {}.\n",
                         with_atoms.add_rows(prefix + "/exponent-of-atoms", rows),
                         with_active.add_rows(prefix + "/exponent-of-active", rows));
    return table;
}

std::string bench_adaptive(const std::string& scene_name, const SceneDescription& scene,
                           const AdaptiveBenchSettings& settings, std::vector<BenchRow>& rows) {
    const Connectivity connectivity = load_system(scene).connectivity;
    const Start start = load_start(scene, connectivity);
    const std::string prefix = "adaptive/" + scene_name;
    References references{build_poses(start, settings.poses), {}};
    Flexible exact =
        build_variant(start, {everything, {}, JointWeights::Plain, PairPrecision::Double});
    const TorsionState& rest = references.poses.front().rest;
    put(rest, exact);
    say("all joints along the stroke");
    references.path = play_stroke(start, settings.stroke_moves, exact).forces;
    put(rest, exact);
    move_held(exact, {apart, 0, 0});
    (void)step_flexible(exact);
    move_held(exact, {-apart, 0, 0});
    put(TorsionState(exact.state), exact);
    const std::vector<double> floor =
        relative_errors(play_stroke(start, settings.stroke_moves, exact).forces, references.path);
    rows.push_back({prefix + "/floor", floor, "relative", rms_of(floor), "relative",
                    "the same begun 0.001 A apart"});
    std::string table{table_head};
    for (const std::optional<double>& cutoff : cutoffs) {
        std::vector<Result> results;
        double all_us = 0, worst = 0;
        std::string slowest;
        for (const Variant& variant : list_variants(start, cutoff)) {
            say(name_of(variant));
            results.push_back(run_variant(start, references, variant));
            const Result& result = results.back();
            const double mean = result.stroke.mean_us();
            if (variant.active == everything) {
                all_us = mean;
            } else if (mean / all_us > worst) {
                worst = mean / all_us;
                slowest = name_of(variant);
            }
            add_rows(fmt::format("{}/{}", prefix, name_of(variant)), result, references, all_us,
                     rows);
            table += table_line(result, all_us);
        }
        add_relations(prefix, results, rows);
        if (worst == 0) continue;
        rows.push_back({fmt::format("{}/slowest/{}", prefix, cutoff_name(cutoff)),
                        {worst},
                        "of all joints'",
                        {},
                        "",
                        slowest});
    }
    return table +
           fmt::format("\nTwo runs with all joints along the stroke, 0.001 Å apart: {:.2g} %.\n",
                       100 * rms_of(floor));
}

}  // namespace palpa
