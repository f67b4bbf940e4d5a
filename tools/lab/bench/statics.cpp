#include "tools/lab/bench/statics.h"

#include "core/load_error.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/probe.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "tools/lab/bench/second_derivatives.h"
#include "tools/lab/bench/steppers.h"

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <optional>

namespace palpa {
namespace {

constexpr std::array levels{30.0, 10.0, 3.0, 1.0};  // kcal/mol per radian and Å
constexpr double shift = 0.3;                       // Å, of the molecule in hand
constexpr std::size_t most_steps = 3000;

void bench_method(const std::string& scene_name, World world, RelaxMethod method,
                  std::vector<BenchRow>& rows) {
    move_held(world, Vec3(shift, 0, 0));
    RelaxSettings settings;
    settings.method = method;
    settings.step.forces = build_step_settings(world).forces;
    settings.steps = most_steps;
    settings.force_tolerance = levels.back();
    const char* const name = method == RelaxMethod::QuasiStatic ? "quasi-static" : "l-bfgs";
    std::size_t level = 0;
    QuasiStatics statics = build_quasi_statics(model_of(world));
    const auto begin = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    const auto reached = [&](std::size_t steps, double energy, double rms) {
        for (; level < levels.size() && rms <= levels[level]; ++level) {
            rows.push_back({fmt::format("statics/{}/{}/rms={}", scene_name, name, levels[level]),
                            {1e3 * seconds()},
                            "ms",
                            {},
                            "",
                            fmt::format("{} steps, {} evaluations, {:.2f} kcal/mol", steps,
                                        statics.memory.evaluations, energy)});
        }
    };
    const JointRelaxReport report =
        relax_joints(model_of(world), settings, world.write<TorsionState>(), statics,
                     [&](const RelaxProgress& progress) {
                         reached(progress.step, progress.energy, progress.rms_force);
                         return true;
                     });
    reached(report.steps, report.energy_after, report.rms_force);
    if (level == levels.size()) return;
    rows.push_back(
        {fmt::format("statics/{}/{}/end", scene_name, name),
         {1e3 * seconds()},
         "ms",
         {},
         "",
         fmt::format("stopped at rms={:.3g} after {} steps, {} evaluations, {:.2f} kcal/mol",
                     report.rms_force, report.steps, report.evaluations, report.energy_after)});
}

// Joints within a distance only, and side chains alone: all that is not in the hand is fixed then.
void bench_region(const std::string& scene_name, SceneDescription scene,
                  std::optional<double> within, bool side_chains, std::vector<BenchRow>& rows) {
    scene.joints.within_angstrom = within;
    scene.joints.backbone = !side_chains;
    for (MoleculeDescription& molecule : scene.molecules) {
        if (side_chains && molecule.motion == Motion::Free) molecule.motion = Motion::Fixed;
    }
    scene.statics.method = RelaxMethod::QuasiStatic;
    scene.statics.steps = 1;
    scene.statics.relax_steps = 0;
    World world = load_world(scene);
    if (!has_mobile(world)) return;
    ContactModel felt = contact_at(world, 0).model;
    HandPose hand;
    const std::string reference =
        fmt::format("{} joints, {} tiles", world.resource<StartReport>().joints,
                    find_solver<PaperStep>(world)->statics.memory.fast_pairs.list.plain.size());
    const std::vector<double> samples = sample(21, 1e3, [&] {
        hand.travel_m.x() += 1e-6;
        (void)step_world(world, hand, felt);
        felt = contact_at(world, 0).model;
    });
    rows.push_back(
        {fmt::format("statics/{}/step/{}within={}", scene_name, side_chains ? "side-chains/" : "",
                     within ? fmt::format("{}", *within) : "all"),
         samples,
         "ms",
         {},
         "",
         reference});
}

}  // namespace

void bench_statics(const std::string& scene_name, const SceneDescription& scene,
                   std::vector<BenchRow>& rows) {
    const World start = load_world(scene);
    if (!has_mobile(start)) {
        throw LoadError({scene.file.string()},
                        "no molecule of this scene moves by itself; expected a flexible scene such "
                        "as scenes/hiv/flexible.toml");
    }
    bench_second_derivatives(scene_name, start, rows);
    bench_steppers(scene_name, start, rows);
    for (const RelaxMethod method : {RelaxMethod::QuasiStatic, RelaxMethod::SecondOrder})
        bench_method(scene_name, start, method, rows);
    for (const bool side_chains : {false, true}) {
        for (const std::optional<double> within : {std::optional(4.0), std::optional(8.0),
                                                   std::optional(12.0), std::optional<double>()}) {
            bench_region(scene_name, scene, within, side_chains, rows);
        }
    }
}

}  // namespace palpa
