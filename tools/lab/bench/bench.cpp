#include "tools/lab/bench/bench.h"

#include "charmm/force_field.h"
#include "core/files.h"
#include "core/machine.h"
#include "core/text.h"
#include "core/units.h"
#include "core/version.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "simulation/systems/publish_contact.h"
#include "tools/commands/command.h"
#include "tools/commands/progress.h"
#include "tools/lab/bench/adaptive.h"
#include "tools/lab/bench/answer.h"
#include "tools/lab/bench/engine.h"
#include "tools/lab/bench/kernel.h"
#include "tools/lab/bench/meshes.h"
#include "tools/lab/bench/mouse.h"
#include "tools/lab/bench/repeat_world.h"
#include "tools/lab/bench/representations.h"
#include "tools/lab/bench/row.h"
#include "tools/lab/bench/servo.h"
#include "tools/lab/bench/statics.h"
#include "tools/lab/bench/tree.h"
#include "tools/lab/bench/window.h"
#include "tools/lab/experiments/rest_poses.h"
#include "tools/lab/report/answer.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace palpa {
namespace {

// What a step says of the force with what the first hand holds at `distance` along its line; of
// what moves by itself, what rigid molecules would feel there. kcal/mol/Å.
double find_step_force(World& world, double distance) {
    if (is_mobile(world, hand_at(world, 0))) return force_along_line_at(world, distance).force;
    move_grabbed(world, distance);
    return build_local_contact(world, hand_at(world, 0), {}).model.force_newton.x() /
           units::newton_per_kcal_per_mol_angstrom;
}

// One simulation step, while the hand sweeps back and forth over 10 mm.
BenchRow bench_step(const std::string& scene_name, World world) {
    // Steps too short for the clock are timed together.
    const int batch = moves_in_space(world) ? 1 : 200;
    BenchRow row{
        "step/" + scene_name, {}, "us", {}, "relative", "central difference of the energy"};
    ContactModel felt = contact_at(world, 0).model;
    HandPose hand;
    int tick = 0;
    row.samples = sample(101, 1e6 / batch, [&] {
        for (int i = 0; i < batch; ++i, ++tick) {
            hand.travel_m.x() = 0.005 * std::sin(0.01 * tick);
            (void)step_world(world, hand, felt);
            felt = contact_at(world, 0).model;
        }
    });
    double worst = 0;
    constexpr double h = 1e-4;
    const double nearest = moves_in_space(world) ? -0.5 : 2.4,
                 farthest = moves_in_space(world) ? 0.5 : 8;
    for (double distance = nearest; distance < farthest; distance += 0.1) {
        const double slope = (force_along_line_at(world, distance + h).energy -
                              force_along_line_at(world, distance - h).energy) /
                             (2 * h);
        const double force = find_step_force(world, distance);
        worst = std::max(worst, std::abs(force + slope) / std::max(std::abs(force), 1.0));
    }
    row.error = worst;
    return row;
}

// The copies that a step's transaction makes of what the step writes; the reference says which
// share of a step they take.
BenchRow bench_transaction(const std::string& scene_name, World world, double step_us) {
    BenchRow row{"transaction/" + scene_name, {}, "us"};
    row.samples = sample(1001, 1e6, [&] {
        world.begin();
        world.set_resource(StepReport{});
        (void)world.write_if<AtomTable>();
        (void)world.write_if<TorsionState>();
        (void)world.write_if<GatheredSprings>();
        (void)world.write_if<Clock>();
        (void)world.write_if<Solver>();
        world.write_each<Hand>([](Entity, const Hand&) {});
        world.write_each<Grip>([](Entity, const Grip&) {});
        world.write_each<Spring>([](Entity, const Spring&) {});
        world.write_each<Contact>([](Entity, const Contact&) {});
        world.commit();
    });
    row.reference = fmt::format("{:.2g} of a step", quantile(row.samples, 0.5) / step_us);
    return row;
}

// And with all pairs in double, where steps have them in single precision.
void bench_steps(const std::string& scene_name, const World& world, std::vector<BenchRow>& rows) {
    rows.push_back(bench_step(scene_name, world));
    rows.push_back(bench_transaction(scene_name, world, quantile(rows.back().samples, 0.5)));
    if (!has_fast_pairs(world, hand_at(world, 0))) return;
    World in_double = world;
    in_double.write<Interactions>().precision = PairPrecision::Double;
    rows.push_back(bench_step(scene_name + "/double", std::move(in_double)));
}

// The scene as `palpa run` plays it, 10 s at its own period, without a recording.
BenchRow bench_lockstep(const std::string& scene_name, SceneDescription scene) {
    scene.seconds = 10;
    BenchRow row{fmt::format("lockstep/{}/period={}ms/seconds=10", scene_name, scene.period_ms),
                 {},
                 "s",
                 {},
                 "J",
                 "net work of the first run"};
    std::optional<double> first;
    double worst = 0;
    for (int run = 0; run < 7; ++run) {
        World world = load_world(scene);
        EmulatedOmni device(build_emulated_omni(scene, world));
        Summary summary;
        row.samples.push_back(
            seconds_of([&] { summary = run_headless(scene, world, device, {}, nullptr, {}); }));
        const double work = summary.net_work_J;
        worst = std::max(worst, std::abs(work - first.value_or(work)));
        first = first.value_or(work);
    }
    row.error = worst;
    return row;
}

// `read` returns what stands beside the time: how much was read.
template <class Read>
BenchRow bench_read(const std::string& name, const Read& read) {
    BenchRow row{"load/" + name, {}, "ms"};
    row.samples = sample(21, 1e3, [&] { row.reference = read(); });
    return row;
}

void bench_files(const BenchOptions& options, std::vector<BenchRow>& rows) {
    for (const std::filesystem::path& path : options.structures) {
        rows.push_back(bench_read(path.filename().string(), [&] {
            const bool is_psf = upper_case(path.extension().string()) == ".PSF";
            return fmt::format("{} atoms", is_psf ? read_psf(path).names.size()
                                                  : read_structure(path).names.size());
        }));
    }
    if (options.toppar.empty()) return;
    rows.push_back(bench_read("toppar", [&] {
        return fmt::format("{} types", read_force_field(options.toppar).types.size());
    }));
}

void write_picture(const Answers& answers, const std::filesystem::path& path, Existing existing) {
    write_text_file(
        path,
        std::string(answer_picture_mark) + draw_svg(plot_answers(answers), answer_picture_size),
        existing);
}

nlohmann::ordered_json as_json(const BenchRow& row) {
    nlohmann::ordered_json json;
    json["name"] = row.name;
    json["median"] = quantile(row.samples, 0.5);
    json["p10"] = quantile(row.samples, 0.1);
    json["p90"] = quantile(row.samples, 0.9);
    json["unit"] = row.unit;
    json["error"] = row.error ? nlohmann::ordered_json(*row.error) : nullptr;
    json["error_unit"] = row.error_unit;
    json["reference"] = row.reference;
    for (const auto& [key, value] : row.more) json[key] = value;
    return json;
}

}  // namespace

int bench_command(const BenchOptions& options) {
    AnswerBenchSettings answer_settings = options.answer_settings;
    if (const auto& poses = answer_settings.poses.save_to)
        answer_settings.poses.existing = check_output(*poses, rest_poses_mark, options.overwrites);
    Existing existing_plot = Existing::Refuse;
    if (options.plot) {
        existing_plot = check_output(*options.plot, answer_picture_mark, options.overwrites);
        check_gnuplot();
    }
    std::vector<BenchRow> rows;
    std::string tables;
    bench_files(options, rows);
    if (options.kernel && options.scenes.empty()) bench_gas_kernels(rows);
    if (options.servo) bench_made_up_servo(rows);
    if (options.engine) bench_engine(rows);
    if (options.render && options.atoms == 0) bench_meshes(rows);
    if (options.window) bench_window(options.scenes, rows);
    for (const std::filesystem::path& path : options.scenes) {
        if (options.window) break;
        const SceneDescription scene = read_scene(path, options.settings);
        refuse_remote_engine(scene);
        const std::filesystem::path folder = std::filesystem::absolute(scene.file).parent_path();
        const std::string name = folder.filename().string();
        fmt::print(stderr, "timing {}\n", name);
        ProgressLine progress;
        const StageFunction on_stage = progress.stages();
        if (options.kernel) {
            bench_kernels(name, scene, rows);
            continue;
        }
        if (options.mouse) {
            bench_mouse(name + "/" + scene.file.stem().string(), scene, options.runs,
                        options.longest_s, rows);
            continue;
        }
        if (options.servo) {
            bench_servo(name, scene, rows);
            continue;
        }
        if (options.render) {
            World world = load_world(scene, on_stage);
            if (options.atoms == 0) {
                bench_representations(name, std::move(world), rows);
            } else {
                bench_large_pictures(name, repeat_world(std::move(world), options.atoms), rows);
            }
            continue;
        }
        if (options.statics) {
            bench_statics(name, scene, rows);
            continue;
        }
        if (options.answer) {
            const Answers answers = bench_answer(name, scene, answer_settings, rows);
            tables += format_markdown(answers);
            if (options.plot) write_picture(answers, *options.plot, existing_plot);
            continue;
        }
        if (options.adaptive) {
            const auto bench = options.spheres ? bench_spheres
                               : options.best  ? bench_best_joints
                                               : bench_adaptive;
            tables += bench(name, scene, options.adaptive_settings, rows);
            continue;
        }
        if (options.tree) {
            bench_tree(name, load_world(scene, on_stage).resource<AtomTable>(), rows);
            continue;
        }
        rows.push_back(bench_read(name, [&] {
            load_world(read_scene(path, options.settings));
            return std::string();
        }));
        bench_steps(name, load_world(scene, on_stage), rows);
        rows.push_back(bench_lockstep(name, scene));
    }
    if (options.tree) bench_polymers(rows);
    if (options.table) {
        fmt::print("{}, commit {}\n\n{}", machine_name(), commit_name, tables);
        return 0;
    }
    nlohmann::ordered_json report{{"machine", machine_name()}, {"commit", commit_name}};
    report["rows"] = nlohmann::ordered_json::array();
    for (const BenchRow& row : rows) report["rows"].push_back(as_json(row));
    if (!tables.empty()) report["table"] = tables;
    if (options.json) {
        fmt::print("{}\n", report.dump(2));
        return 0;
    }
    fmt::print("{}, commit {}\n{:<58}{:>10}{:>10}{:>10}\n", machine_name(), commit_name, "",
               "median", "p10", "p90");
    for (const BenchRow& row : rows) {
        fmt::print("{:<58}{:>10.4g}{:>10.4g}{:>10.4g} {}", row.name, quantile(row.samples, 0.5),
                   quantile(row.samples, 0.1), quantile(row.samples, 0.9), row.unit);
        if (row.error) {
            fmt::print(", error {:.2g} {} against {}", *row.error, row.error_unit, row.reference);
        } else if (!row.reference.empty()) {
            fmt::print(", {}", row.reference);
        }
        fmt::print("\n");
    }
    return 0;
}

}  // namespace palpa
