// palpa bench: which benches are asked for.
#include "tools/bench/bench.h"

#include "tools/commands/command.h"

#include <algorithm>
#include <memory>

namespace palpa {
namespace {

void add_adaptive_options(CLI::App& bench, BenchOptions& options) {
    CLI::Option* const adaptive =
        bench
            .add_flag("--adaptive", options.adaptive,
                      "time steps of flexible scenes with few active joints, and say how wrong "
                      "they are, instead")
            ->excludes("--render")
            ->excludes("--kernel")
            ->excludes("--tree")
            ->excludes("--statics")
            ->needs("scenes");
    bench
        .add_flag("--spheres", options.spheres,
                  "only time them, in spheres around the residue in hand")
        ->needs(adaptive);
    bench
        .add_flag(
            "--best", options.best,
            "only say how wrong forces are with the best active joints, chosen without time limit")
        ->excludes("--spheres")
        ->needs(adaptive);
    CLI::Option* const answer =
        bench
            .add_flag("--answer", options.answer,
                      "error of the force at the hand against the time spent on it, of each way to "
                      "move flexible scenes, instead")
            ->excludes("--render")
            ->excludes("--kernel")
            ->excludes("--tree")
            ->excludes("--statics")
            ->excludes(adaptive)
            ->needs("scenes");
    bench
        .add_option(
            "--poses", options.poses,
            "along the stroke: 3 unless given, 10 with --answer (all of --poses-file), whose 0 is "
            "only the ways")
        ->check(in_range(0, 1000));
    bench.add_flag("--no-ways", options.answer_settings.no_ways, "only the poses")->needs(answer);
    AnswerPoseSettings& poses = options.answer_settings.poses;
    CLI::Option* const poses_file =
        bench
            .add_option("--poses-file", poses.file,
                        "take the poses of --answer from this file, all or the first --poses")
            ->needs(answer);
    bench
        .add_option("--save-poses", poses.save_to,
                    "write the poses that --answer finds, for --poses-file")
        ->excludes(poses_file)
        ->needs(answer);
    bench.add_option("--plot", options.plot, "draw what --answer measures into this SVG file")
        ->needs(answer);
    add_overwrite_flag(bench, options.overwrites);
    bench
        .add_option("--stroke-steps", options.adaptive_settings.stroke_moves,
                    "of the hand by 0.005 Å, half of them back; 200 unless given")
        ->check(in_range(20, 1'000'000))
        ->needs(adaptive);
    bench
        .add_option("--only", options.adaptive_settings.only,
                    "all joints and what has this in its name, as active=40/cutoff=12/near-hand")
        ->excludes("--spheres")
        ->excludes("--best")
        ->needs(adaptive);
    bench.add_flag("--table", options.table,
                   "print a table in Markdown, of --adaptive or --answer");
}

}  // namespace

void add_bench(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& bench = *program.add_subcommand("bench", "Speed against error on this machine");
    const auto owned = std::make_shared<BenchOptions>();
    BenchOptions& options = *owned;
    bench.final_callback([owned, &chosen] {
        if (owned->scenes.empty() && owned->structures.empty() && owned->toppar.empty() &&
            !owned->kernel && !owned->tree && !owned->servo && !owned->engine) {
            throw CLI::RequiredError(
                "a scene, --engine, --kernel, --load, --servo, --toppar or --tree");
        }
        if (owned->table && !owned->adaptive && !owned->answer)
            throw CLI::RequiredError("--table: --adaptive or --answer");
        AnswerPoseSettings& poses = owned->answer_settings.poses;
        const bool has_file = poses.file || poses.save_to || owned->plot;
        if (has_file && owned->scenes.size() != 1)
            throw CLI::ValidationError("--poses-file, --save-poses, --plot", "expected one scene");
        if (has_file && owned->poses == 0)
            throw CLI::ValidationError("--poses", "expected 1 or more with a file");
        if (poses.save_to && poses.save_to == owned->plot)
            throw CLI::ValidationError("--plot", "expected another file than --save-poses");
        poses.count = owned->poses;
        if (owned->poses) owned->adaptive_settings.poses = std::max(1, *owned->poses);
        chosen = [owned] { return bench_command(*owned); };
    });
    describe(bench, "Look and measure",
             {"palpa bench scenes/water scenes/hiv", "palpa bench --kernel",
              "palpa bench scenes/hiv/flexible.toml --adaptive --table",
              "palpa bench scenes/hiv/flexible.toml --answer --poses-file "
              "scenes/hiv/flexible-poses.txt --plot answer.svg"});
    bench.add_option("scenes", options.scenes, "scene folders or files");
    bench.add_option("--load", options.structures,
                     "structure files (.pdb, .cif, .crd, .psf): time the reading of each");
    bench.add_option("--toppar", options.toppar,
                     "CHARMM topology and parameter files: time the reading of all together");
    bench.add_flag("--render", options.render, "time pictures instead of steps");
    bench
        .add_option("--atoms", options.atoms,
                    "with --render: repeat each scene until it has so many, 500000 say")
        ->check(in_range(1, 2'000'000))
        ->needs("--render");
    bench
        .add_flag("--kernel", options.kernel,
                  "time the kernels of pairs alone, of all atoms of a scene's topology file; of a "
                  "made-up gas without a scene")
        ->excludes("--render");
    bench
        .add_flag("--tree", options.tree,
                  "time joint accelerations of the scenes' molecules and of polymers, instead")
        ->excludes("--render")
        ->excludes("--kernel");
    bench
        .add_flag(
            "--statics", options.statics,
            "time ways to rest of flexible scenes, and steps with joints in a region, instead")
        ->excludes("--render")
        ->excludes("--kernel")
        ->excludes("--tree")
        ->needs("scenes");
    bench
        .add_flag(
            "--servo", options.servo,
            "time ticks of guarded coupling, of made-up molecules and of the scenes', instead")
        ->excludes("--render")
        ->excludes("--kernel")
        ->excludes("--tree");
    bench
        .add_flag("--window", options.window,
                  "time from opening a window to the first force, of scenes, and of structures, "
                  "which are prepared there; needs a display, instead")
        ->excludes("--render")
        ->excludes("--kernel")
        ->excludes("--tree")
        ->excludes("--servo")
        ->needs("scenes");
    bench
        .add_flag("--engine", options.engine,
                  "time what a frame of a remote engine costs its client")
        ->excludes("scenes");
    add_adaptive_options(bench, options);
    bench.add_flag("--json", options.json, "print JSON");
    add_set_option(bench, options.settings);
}

}  // namespace palpa
