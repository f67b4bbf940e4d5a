// palpa-lab bench: which benches are asked for.
#include "tools/lab/bench/bench.h"

#include "tools/lab/commands/commands.h"

#include <algorithm>
#include <memory>

namespace palpa {
namespace {

void add_adaptive_options(CLI::App& bench, BenchOptions& options) {
    CLI::Option* const adaptive =
        bench
            .add_flag(
                "--adaptive", options.adaptive,
                "instead: time steps of flexible scenes with few active joints, and their errors")
            ->excludes("--render")
            ->excludes("--kernel")
            ->excludes("--tree")
            ->excludes("--statics")
            ->needs("scenes");
    bench
        .add_flag("--spheres", options.spheres,
                  "only time steps, in spheres around the residue in hand")
        ->needs(adaptive);
    bench
        .add_flag("--best", options.best,
                  "only print the errors of forces with the best active joints, chosen without a "
                  "time limit")
        ->excludes("--spheres")
        ->needs(adaptive);
    CLI::Option* const answer = bench
                                    .add_flag("--answer", options.answer,
                                              "instead: error of the force at the hand against "
                                              "computing time, for each method of flexible scenes")
                                    ->excludes("--render")
                                    ->excludes("--kernel")
                                    ->excludes("--tree")
                                    ->excludes("--statics")
                                    ->excludes(adaptive)
                                    ->needs("scenes");
    bench
        .add_option("--poses", options.poses,
                    "number of poses along the stroke: default 3, with --answer 10 (all of "
                    "--poses-file); with --answer 0 only the paths are measured")
        ->check(in_range(0, 1000));
    bench
        .add_flag("--no-ways", options.answer_settings.no_ways,
                  "measure at the poses only, not along paths")
        ->needs(answer);
    AnswerPoseSettings& poses = options.answer_settings.poses;
    CLI::Option* const poses_file =
        bench
            .add_option("--poses-file", poses.file,
                        "read the poses of --answer from this file, all or the first --poses")
            ->needs(answer);
    bench
        .add_option("--save-poses", poses.save_to,
                    "write the poses that --answer finds to this file, for --poses-file")
        ->excludes(poses_file)
        ->needs(answer);
    bench.add_option("--plot", options.plot, "plot the results of --answer into this SVG file")
        ->needs(answer);
    add_overwrite_flag(bench, options.overwrites);
    bench
        .add_option("--stroke-steps", options.adaptive_settings.stroke_moves,
                    "number of hand moves by 0.005 Å, half of them back (default 200)")
        ->check(in_range(20, 1'000'000))
        ->needs(adaptive);
    bench
        .add_option("--only", options.adaptive_settings.only,
                    "measure only all joints and variants with this text in their name, such as "
                    "active=40/cutoff=12/near-hand")
        ->excludes("--spheres")
        ->excludes("--best")
        ->needs(adaptive);
    bench.add_flag("--table", options.table,
                   "print the results of --adaptive or --answer as a Markdown table");
}

}  // namespace

void add_bench(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& bench = *program.add_subcommand("bench", "Measure speed and error on this machine");
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
    describe(bench, {"palpa-lab bench scenes/water scenes/hiv", "palpa-lab bench --kernel",
                     "palpa-lab bench scenes/hiv/flexible.toml --adaptive --table",
                     "palpa-lab bench scenes/hiv/flexible.toml --answer --poses-file "
                     "scenes/hiv/flexible-poses.txt --plot answer.svg"});
    bench.add_option("scenes", options.scenes, "scene folders or files");
    bench.add_option("--load", options.structures,
                     "time reading each of these structure files (.pdb, .cif, .crd, .psf)");
    bench.add_option("--toppar", options.toppar,
                     "time reading these CHARMM topology and parameter files together");
    bench.add_flag("--render", options.render, "instead: time drawing");
    bench
        .add_option("--atoms", options.atoms,
                    "with --render: repeat each scene until it has this many atoms, such as 500000")
        ->check(in_range(1, 2'000'000))
        ->needs("--render");
    bench
        .add_flag("--kernel", options.kernel,
                  "time only the pair kernels, for all atoms of a scene's topology file; without a "
                  "scene, for an artificial gas")
        ->excludes("--render");
    bench
        .add_flag("--tree", options.tree,
                  "instead: time joint accelerations of the scenes' molecules and of polymers")
        ->excludes("--render")
        ->excludes("--kernel");
    bench
        .add_flag("--statics", options.statics,
                  "instead: time relaxation methods of flexible scenes, and steps with joints in a "
                  "region")
        ->excludes("--render")
        ->excludes("--kernel")
        ->excludes("--tree")
        ->needs("scenes");
    bench
        .add_flag("--servo", options.servo,
                  "instead: time servo ticks of guarded coupling, for artificial molecules and "
                  "those of the scenes")
        ->excludes("--render")
        ->excludes("--kernel")
        ->excludes("--tree");
    bench
        .add_flag("--window", options.window,
                  "instead: time from opening a window to the first force, for scenes and for "
                  "structures, which are prepared there; needs a display")
        ->excludes("--render")
        ->excludes("--kernel")
        ->excludes("--tree")
        ->excludes("--servo")
        ->needs("scenes");
    CLI::Option* const mouse =
        bench
            .add_flag("--mouse", options.mouse,
                      "instead: seconds in which an emulated person at the mouse draws what is in "
                      "hand out of its pocket, in real time without a window")
            ->excludes("--render")
            ->excludes("--kernel")
            ->excludes("--tree")
            ->excludes("--servo")
            ->excludes("--window")
            ->needs("scenes");
    bench.add_option("--runs", options.runs, "number of sessions of --mouse (default 5)")
        ->check(in_range(1, 1000))
        ->needs(mouse);
    bench.add_option("--longest", options.longest_s, "longest session of --mouse, s (default 180)")
        ->check(in_range(1.0, 1e4))
        ->needs(mouse);
    bench
        .add_flag("--engine", options.engine,
                  "time the cost of a frame of a remote engine for its client")
        ->excludes("scenes");
    add_adaptive_options(bench, options);
    bench.add_flag("--json", options.json, "print JSON");
    add_set_option(bench, options.settings);
}

}  // namespace palpa
