#include "tools/lab/bench/adaptive.h"

#include "core/units.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/solver.h"
#include "tools/lab/bench/stroke.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

constexpr std::array<std::optional<double>, 2> cutoffs{std::nullopt, 12.0};
constexpr double local_shift = 0.1;  // Å
constexpr std::size_t local_steps = 300;
constexpr double apart = 0.001;  // Å, of the two runs that make the floor

// What rows call JointWeights. Whoever compares runs finds the names that rows have always had.
constexpr std::array<std::string_view, joint_weight_names.size()> weight_rows{"plain", "single",
                                                                              "near-hand"};

// ---- what is compared --------------------------------------------------------------------------

std::string_view weight_name(const Variant& v) {
    return v.active == everything ? "all" : weight_rows[static_cast<std::size_t>(v.weights)];
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

// ---- numbers -----------------------------------------------------------------------------------

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

// ---- from rest ---------------------------------------------------------------------------------

struct LocalEnd {
    Vec3 change;  // of the force on the hand, kcal/mol/Å
    std::vector<Vec3> positions;
    double neglected = 0;  // of the metric, at the last choice
};

Vec3 local_move(const BenchStart& start) {
    return {std::copysign(local_shift, find_reach(start.scene)), 0, 0};
}

LocalEnd play_local(const BenchStart& start, const TorsionState& pose, World& world) {
    put(pose, world);
    const Vec3 before = find_force(world);
    move_held(world, local_move(start));
    LocalEnd end;
    for (std::size_t i = 0; i < local_steps; i += find_solver<PaperStep>(world)->steps) {
        end.neglected = relax_mobile(world, {}).value().neglected;
    }
    end.change = find_force(world) - before;
    end.positions = world.resource<TorsionState>().positions;
    return end;
}

// Most of the way with fast pairs, the end in double. Returns the rms force that is left.
double bring_to_rest(const BenchStart& start, World& fast, World& exact) {
    (void)relax(start, RelaxMethod::SecondOrder, 3000, fast);
    put(fast.resource<TorsionState>(), exact);
    return relax(start, RelaxMethod::SecondOrder, 200, exact);
}

// Where all joints are at rest, and where they go when the hand moves.
struct ReferencePose {
    TorsionState rest;
    double rms_force;
    LocalEnd same_steps, at_rest;
};

std::vector<ReferencePose> build_poses(const BenchStart& start, int count) {
    World guide =
        build_variant(start, {everything, {}, JointWeights::Acceleration, PairPrecision::Fast});
    World exact =
        build_variant(start, {everything, {}, JointWeights::Acceleration, PairPrecision::Double});
    put(start.world.resource<TorsionState>(), guide);
    const double reach = find_reach(start.scene);
    constexpr double long_stride = 0.05;  // Å
    double gone = 0;
    std::vector<ReferencePose> poses;
    for (int i = 0; i < count; ++i) {
        const double to = reach * i / count;
        while (std::abs(to - gone) > 1e-9) {
            const double step = std::clamp(to - gone, -long_stride, long_stride);
            move_held(guide, {step, 0, 0});
            (void)relax_mobile(guide, {}).value();
            gone += step;
        }
        ReferencePose pose;
        pose.rms_force = bring_to_rest(start, guide, exact);
        pose.rest = exact.resource<TorsionState>();
        const Vec3 before = find_force(exact);
        pose.same_steps = play_local(start, pose.rest, exact);
        put(pose.rest, guide);
        move_held(guide, local_move(start));
        const double left = bring_to_rest(start, guide, exact);
        put(pose.rest, guide);
        pose.at_rest = {find_force(exact) - before, exact.resource<TorsionState>().positions};
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
    std::vector<ReferencePose> poses;
    std::vector<Vec3> path;  // forces along the stroke
};

std::vector<Vec3> changes_of(std::span<const ReferencePose> poses, LocalEnd ReferencePose::* end) {
    std::vector<Vec3> changes;
    for (const ReferencePose& pose : poses) changes.push_back((pose.*end).change);
    return changes;
}

Result run_variant(const BenchStart& start, const References& references, const Variant& variant) {
    Result result{variant, {}, {}, {}, {}, {}, {}, {}};
    World world = build_variant(start, variant);
    std::vector<Vec3> changes;
    std::vector<double> neglected;
    for (const ReferencePose& pose : references.poses) {
        const LocalEnd end = play_local(start, pose.rest, world);
        changes.push_back(end.change);
        neglected.push_back(end.neglected);
        result.local_position.push_back(rms_distance(end.positions, pose.same_steps.positions));
    }
    result.local_force =
        relative_errors(changes, changes_of(references.poses, &ReferencePose::same_steps));
    result.local_rest =
        relative_errors(changes, changes_of(references.poses, &ReferencePose::at_rest));
    for (std::size_t i = 0; i < neglected.size(); ++i) {
        result.neglected_force.push_back({neglected[i], result.local_force[i]});
        result.neglected_position.push_back({neglected[i], result.local_position[i]});
    }
    result.stroke = time_stroke(start, references.poses.front().rest,
                                static_cast<int>(references.path.size()), world);
    result.path = relative_errors(result.stroke.forces, references.path);
    return result;
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
    const std::vector<Vec3> same = changes_of(references.poses, &ReferencePose::same_steps);
    const std::vector<Vec3> rest = changes_of(references.poses, &ReferencePose::at_rest);
    add("local-force", result.local_force,
        units::piconewton_per_kcal_per_mol_angstrom * rms_norm(same), "pN",
        fmt::format("{}, as many steps: {:.0f} pN", exact,
                    units::piconewton_per_kcal_per_mol_angstrom * rms_norm(same)));
    add("local-rest", result.local_rest,
        units::piconewton_per_kcal_per_mol_angstrom * rms_norm(rest), "pN",
        fmt::format("{}, at rest: {:.0f} pN", exact,
                    units::piconewton_per_kcal_per_mol_angstrom * rms_norm(rest)));
    add("local-position", result.local_position, 1, "A", exact);
    add("path", result.path,
        units::piconewton_per_kcal_per_mol_angstrom * rms_norm(references.path), "pN",
        fmt::format("{}: {:.0f} pN", exact,
                    units::piconewton_per_kcal_per_mol_angstrom * rms_norm(references.path)));
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

std::vector<Variant> list_variants(const BenchStart& start, const AdaptiveBenchSettings& settings,
                                   const std::optional<double>& cutoff) {
    std::vector<Variant> variants;
    const PairPrecision pairs = start.scene.statics.pairs;
    variants.push_back({everything, cutoff, JointWeights::Acceleration, pairs});
    for (const std::size_t active : active_counts) {
        if (active >= static_cast<std::size_t>(model_of(start.world).coordinates)) continue;
        for (std::size_t w = 0; w < weight_rows.size(); ++w) {
            if (active == 0 && w > 0) continue;
            variants.push_back({active, cutoff, static_cast<JointWeights>(w), pairs});
        }
    }
    const auto is_wanted = [&](const Variant& variant) {
        const std::string name = name_of(variant);
        const auto has = [&](const std::string& part) {
            return name.find(part) != std::string::npos;
        };
        return variant.active == everything || settings.only.empty() ||
               std::ranges::any_of(settings.only, has);
    };
    std::erase_if(variants, [&](const Variant& variant) { return !is_wanted(variant); });
    return variants;
}

void add_relations(const std::string& prefix, std::span<const Result> results,
                   std::vector<BenchRow>& rows) {
    for (std::size_t w = 0; w < weight_rows.size(); ++w) {
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
        const std::string what = fmt::format("{}/{}", cutoff_name(cutoff), weight_rows[w]);
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

}  // namespace

std::string bench_adaptive(const std::string& scene_name, const SceneDescription& scene,
                           const AdaptiveBenchSettings& settings, std::vector<BenchRow>& rows) {
    const Connectivity connectivity = load_system(scene).connectivity;
    const BenchStart start = load_start(scene, connectivity);
    const std::string prefix = "adaptive/" + scene_name;
    References references{build_poses(start, settings.poses), {}};
    World exact =
        build_variant(start, {everything, {}, JointWeights::Acceleration, PairPrecision::Double});
    const TorsionState& rest = references.poses.front().rest;
    put(rest, exact);
    say("all joints along the stroke");
    references.path = play_stroke(start, settings.stroke_moves, exact).forces;
    put(rest, exact);
    move_held(exact, {apart, 0, 0});
    (void)relax_mobile(exact, {}).value();
    move_held(exact, {-apart, 0, 0});
    put(TorsionState(exact.resource<TorsionState>()), exact);
    const std::vector<double> floor =
        relative_errors(play_stroke(start, settings.stroke_moves, exact).forces, references.path);
    rows.push_back({prefix + "/floor", floor, "relative", rms_of(floor), "relative",
                    "the same begun 0.001 A apart"});
    std::string table{table_head};
    for (const std::optional<double>& cutoff : cutoffs) {
        std::vector<Result> results;
        double all_us = 0, worst = 0;
        std::string slowest;
        for (const Variant& variant : list_variants(start, settings, cutoff)) {
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
            const std::string line = table_line(result, all_us);
            say(line.substr(0, line.size() - 1));
            table += line;
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
