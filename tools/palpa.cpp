// The program: reads the command line, calls one command, turns errors into exit codes.
#include "core/load_error.h"
#include "core/text.h"
#include "core/version.h"
#include "gpu/device.h"
#include "platform/window.h"
#include "scene/read_scene.h"
#include "tools/bench.h"
#include "tools/command_line.h"
#include "tools/devices.h"
#include "tools/energy.h"
#include "tools/feel.h"
#include "tools/forced_choice.h"
#include "tools/journey.h"
#include "tools/loops.h"
#include "tools/prepare.h"
#include "tools/relax.h"
#include "tools/render.h"
#include "tools/replay.h"
#include "tools/report.h"
#include "tools/run.h"
#include "tools/scenarios.h"
#include "tools/start.h"
#include "tools/study.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace {

constexpr int bad_input = 2, own_fault = 3;

void add_set_option(CLI::App& command, std::vector<std::string>& settings) {
    command
        .add_option_function<std::string>(
            "--set", [&settings](const std::string& value) { settings.push_back(value); },
            "any key of the scene file, in full or by its last part; 'palpa run --keys' lists "
            "them")
        ->type_name("KEY=VALUE")
        ->trigger_on_parse()
        ->take_last();
    command.add_flag_callback(
        std::string(palpa::allow_outside),
        [&settings] { settings.emplace_back(palpa::allow_outside); },
        "let the scene name files outside of its folder");
}

// A flag that switches something off.
void add_negation(CLI::App& command, const std::string& flag, bool& value,
                  const std::string& help) {
    command.add_flag_callback(flag, [&value] { value = false; }, help);
}

// A number between two, which a NaN is not.
CLI::Validator in_range(double lowest, double highest) {
    return CLI::Validator(
        [lowest, highest](const std::string& text) {
            const std::optional<double> value = palpa::find_real(text);
            if (value && *value >= lowest && *value <= highest) return std::string();
            return fmt::format("'{}' is not a number from {} to {}", text, lowest, highest);
        },
        fmt::format("{} to {}", lowest, highest));
}

// A whole number as the key run.seed takes it; CLI11 would wrap others round.
void add_seed_option(CLI::App& command, std::uint64_t& seed) {
    static constexpr std::int64_t highest = 1'000'000'000'000'000;
    command
        .add_option_function<std::string>(
            "--seed",
            [&seed](const std::string& text) {
                const std::optional<std::int64_t> value = palpa::find_integer(text);
                if (!value || *value < 0 || *value > highest) {
                    throw CLI::ValidationError(
                        "--seed",
                        fmt::format("'{}' is not a whole number from 0 to {}", text, highest));
                }
                seed = static_cast<std::uint64_t>(*value);
            },
            "random seed, 1 unless given")
        ->type_name("UINT");
}

void add_size_option(CLI::App& command, const std::string& option, std::uint32_t& width,
                     std::uint32_t& height) {
    command
        .add_option_function<std::string>(
            option,
            [option, &width, &height](const std::string& text) {
                const std::size_t by = text.find('x');
                const auto wide = palpa::find_integer(text.substr(0, by));
                const auto high =
                    palpa::find_integer(by == std::string::npos ? "" : text.substr(by + 1));
                if (!wide || !high || *wide < 1 || *high < 1 || *wide > 1'000'000 ||
                    *high > 1'000'000) {
                    throw CLI::ValidationError(option,
                                               "'" + text + "' is no size; expected WIDTHxHEIGHT");
                }
                if (*wide * *high > palpa::most_pixels) {
                    throw CLI::ValidationError(option, fmt::format("'{}' has more than {} pixels",
                                                                   text, palpa::most_pixels));
                }
                width = static_cast<std::uint32_t>(*wide);
                height = static_cast<std::uint32_t>(*high);
            },
            fmt::format("in pixels, {}x{} unless given", width, height))
        ->type_name("WIDTHxHEIGHT");
}

// Of every command that writes files.
void add_overwrite_flag(CLI::App& command, bool& overwrites) {
    command.add_flag("--overwrite", overwrites,
                     "replace what this command wrote before; other files are never replaced");
}

void add_toppar_option(CLI::App& command, std::vector<std::filesystem::path>& toppar) {
    command.add_option("--toppar", toppar, "CHARMM topology, parameter and stream files, in order")
        ->type_name("FILE")
        ->required();
}

void add_window_options(CLI::App& run, palpa::RunOptions& options) {
    run.option_defaults()->group("In a window");
    run.add_flag("--play", options.play,
                 "the emulated hand plays the scene's stroke, not the mouse");
    run.add_flag("--sound", options.sound,
                 "play the felt force as a tone, the stronger the higher and louder");
    add_size_option(run, "--size", options.width, options.height);
    run.get_option("--size")->each([&options](const std::string&) { options.has_size = true; });
    run.add_option("--screenshots", options.screenshots,
                   "folder for screenshots, the present one "
                   "unless given")
        ->type_name("FOLDER");
    CLI::Option* const shot =
        run.add_option("--shot", options.last_shot, "a picture of the window, which then closes")
            ->type_name("FILE.png");
    run.add_option("--after", options.last_shot_s, "seconds until --shot, 5 unless given")
        ->check(in_range(0.0, 1e5))
        ->needs(shot);
    run.add_flag("--validation", options.validation,
                 "let the Vulkan validation layer watch the drawing");
    run.add_option("--lose-device-at", options.lose_device_at)->group("");  // a test's
}

void add_headless_options(CLI::App& run, palpa::RunOptions& options) {
    run.option_defaults()->group("Without a window");
    run.add_flag("--headless", options.headless,
                 "in lockstep on a virtual clock: the same command gives the same bytes");
    CLI::Option* const record =
        run.add_option("--record", options.record,
                       "for trace.csv, summary.json, session.toml and frames")
            ->type_name("FOLDER");
    add_overwrite_flag(run, options.overwrites);
    run.add_option("--fps", options.frames_per_second,
                   "frames/0000.png ... into the recording, this many a simulated second")
        ->check(in_range(0.01, 1000.0))
        ->needs(record);
    add_size_option(run, "--frame-size", options.frame_width, options.frame_height);
    run.add_flag("--json", options.json, "print the summary as JSON");
}

void add_run(CLI::App& program, palpa::RunOptions& options) {
    CLI::App& run = *program.add_subcommand("run", "A scene in a window, or without one");
    palpa::describe(run, "Feel",
                    {"palpa run hiv", "palpa run scenes/water --headless --record recordings/water",
                     "palpa run scenes/water --headless --mode 2 --period-ms 14 --friction 0",
                     "palpa run scenes/hiv/flexible.toml --play"});
    run.add_option("scene", options.scene,
                   "scene folder or file, recorded session.toml, or the name of one of Palpa's own "
                   "scenes")
        ->required();
    run.add_flag("--check", options.check_only,
                 "only read the scene and say what is wrong with it");
    run.add_flag_callback(
        "--keys",
        [] {
            palpa::print_scene_keys();
            throw CLI::Success();
        },
        "list the keys of scene files, and do nothing else");
    run.option_defaults()->group("Hand and device");
    run.add_option_function<std::string>(
        "--device",
        [&options](const std::string& name) {
            if (name == "list") {
                palpa::print_device_list();
                throw CLI::Success();
            }
            options.device = name;
        },
        "mouse unless given, without a window emulated; 'list' lists them");
    run.add_option("--second", options.second,
                   "another device, for a second hand that holds the other molecule");
    std::vector<std::string>& settings = options.settings;
    palpa::add_setting(run, "--hand", "none, light, slack, medium, firm or firm-grip", settings);
    palpa::add_setting(run, "--friction", "Coulomb friction of the emulated device, N", settings);
    run.option_defaults()->group("Coupling and simulation");
    palpa::add_setting(run, "--mode", "guarded, or 1 to 5 as in the paper", settings);
    palpa::add_setting(run, "--period-ms", "time between two steps of the simulation, ms",
                       settings);
    palpa::add_setting(
        run, "--engage",
        "at-once, or ramp: the force of guarded coupling comes after a pause, in 2 s", settings);
    palpa::add_setting(run, "--seconds", "length of the run", settings);
    palpa::add_setting(run, "--seed", "random seed, 1 unless given", settings);
    palpa::add_setting(run, "--every", "write every Nth row of the trace", settings);
    add_set_option(run, settings);
    add_window_options(run, options);
    add_headless_options(run, options);
}

void add_adaptive_options(CLI::App& bench, palpa::BenchOptions& options) {
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
        .add_flag("--best", options.best,
                  "only say how wrong the joints are that matter most, chosen at leisure")
        ->excludes("--spheres")
        ->needs(adaptive);
    bench
        .add_option("--poses", options.adaptive_settings.poses, "along the stroke, 3 unless given")
        ->check(in_range(1, 1000))
        ->needs(adaptive);
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
    bench.add_flag("--table", options.table, "print a table in Markdown")->needs(adaptive);
}

void add_bench(CLI::App& program, palpa::BenchOptions& options) {
    CLI::App& bench = *program.add_subcommand("bench", "Speed against error on this machine");
    palpa::describe(bench, "Look and measure",
                    {"palpa bench scenes/water scenes/hiv", "palpa bench --kernel",
                     "palpa bench scenes/hiv/flexible.toml --adaptive --table"});
    bench.add_option("scenes", options.scenes, "scene folders or files");
    bench.add_option("--load", options.structures,
                     "structure files (.pdb, .cif, .crd, .psf): time the reading of each");
    bench.add_option("--toppar", options.toppar,
                     "CHARMM topology and parameter files: time the reading of all together");
    bench.final_callback([&options] {
        if (options.scenes.empty() && options.structures.empty() && options.toppar.empty() &&
            !options.kernel && !options.tree && !options.servo) {
            throw CLI::RequiredError("a scene, --kernel, --load, --servo, --toppar or --tree");
        }
    });
    bench.add_flag("--render", options.render, "time pictures instead of steps");
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
    add_adaptive_options(bench, options);
    bench.add_flag("--json", options.json, "print JSON");
    add_set_option(bench, options.settings);
}

void add_render(CLI::App& program, palpa::RenderOptions& options) {
    CLI::App& render = *program.add_subcommand("render", "A picture of a scene; needs no display");
    palpa::describe(render, "Look and measure", {"palpa render scenes/hiv -o tunnel.png"});
    render.add_option("scene", options.scene, "scene folder or file")->required();
    render.add_option("-o,--output", options.image, "PNG file to write")->required();
    add_overwrite_flag(render, options.overwrites);
    add_size_option(render, "--size", options.width, options.height);
    render.add_option("--time", options.time_s, "seconds that the hand plays before the picture")
        ->check(in_range(0.0, 1e5));
    render
        .add_option(
            "--as,--representation", options.representation,
            "ball-and-stick, space-filling, licorice, in-hand: all but the molecule in hand "
            "thin, or pocket: of these what is near to it, and backbones; this and what "
            "follows: unless given, as the scene's [view] says")
        ->type_name("NAME");
    render.add_option("--colour,--colouring", options.colouring,
                      "chain: carbons in a colour of their chain; or element");
    render
        .add_option("--camera", options.camera,
                    "degrees around what is framed and above it, and how many times nearer")
        ->type_name("AZIMUTH,ELEVATION[,ZOOM]");
    render.add_option("--look-at", options.look_at, "a molecule of the scene to frame, not all");
    render.add_flag_callback(
        "--clip", [&options] { options.clips = true; },
        "leave out what stands in front of the molecule in hand");
    render.add_flag_callback(
        "--no-clip", [&options] { options.clips = false; }, "show it, whatever the scene says");
    render.add_option("--samples", options.samples, "averaged for a pixel: 1, 4, 9 or 16")
        ->check(CLI::IsMember({1, 4, 9, 16}));
    add_negation(render, "--no-arrow", options.arrow, "without the force on the molecule");
    add_set_option(render, options.settings);
}

void add_energy(CLI::App& program, palpa::EnergyOptions& options) {
    CLI::App& energy = *program.add_subcommand("energy", "Energies term by term, and forces");
    palpa::describe(energy, "Look and measure",
                    {"palpa energy system.psf --coordinates system.crd --toppar top_all36_prot.rtf "
                     "par_all36m_prot.prm"});
    energy.add_option("system", options.system, "PSF, or a structure that has all its atoms")
        ->required();
    energy.add_option("--coordinates", options.coordinates, "of a PSF: .crd, .pdb or .cif")
        ->type_name("FILE");
    add_toppar_option(energy, options.toppar);
    energy.add_option("--method", options.method, "all-pairs, or cutoff (all-pairs unless given)")
        ->type_name("NAME");
    energy
        .add_option("--coulomb-constant", options.nonbonded.coulomb_constant,
                    "kcal Å/mol/e^2, CHARMM's 332.0716 unless given")
        ->check(in_range(0.0, 1e6));
    energy.add_option("--dielectric", options.nonbonded.dielectric, "1 unless given")
        ->check(in_range(1e-6, 1e6));
    energy.add_flag("--distance-dielectric", options.nonbonded.distance_dielectric,
                    "a dielectric of that times the distance in Å");
    energy.add_option("--cutoff", options.cutoff, "Å, 12 unless given")->check(in_range(0.0, 1e6));
    energy.add_option("--switch-from", options.switch_from, "Å, 10 unless given")
        ->check(in_range(0.0, 1e6));
    energy.add_option("--electrostatics", options.electrostatics,
                      "with cutoff: shift, switch, fshift or fswitch (fshift unless given)");
    energy.add_option("--van-der-waals", options.van_der_waals,
                      "with cutoff: switch or fswitch (switch unless given)");
    energy
        .add_option("--forces", options.forces, "CSV file for the force on every atom, kcal/mol/Å")
        ->type_name("FILE");
    add_overwrite_flag(energy, options.overwrites);
    energy.add_flag("--json", options.json, "print JSON");
}

void add_prepare(CLI::App& program, palpa::PrepareOptions& options) {
    palpa::PrepareSettings& settings = options.settings;
    CLI::App& prepare = *program.add_subcommand(
        "prepare", "Complete and type a structure: hydrogens, patches, topology, a report");
    palpa::describe(
        prepare, "Make scenes",
        {"palpa prepare 1hsg.pdb --without MK1 -o my-protease --toppar top_all36_prot.rtf "
         "par_all36m_prot.prm toppar_water_ions.str"});
    prepare.add_option("structure", options.structure, ".pdb, .ent, .cif or .crd")->required();
    add_toppar_option(prepare, options.toppar);
    prepare
        .add_option("-o,--output", options.folder,
                    "folder for system.psf, .pdb, .crd, .prm, report.txt and scene.toml")
        ->required();
    prepare
        .add_option("--without", settings.without,
                    "residue names (MK1), chains (chain:B) or residues (A:101) to leave out")
        ->type_name("WHAT");
    prepare.add_option("--as", options.as, "take a residue as another, CSO=CYS");
    prepare.add_option("--protonation", options.protonation, "a residue (HSE) or a patch (ASPP)")
        ->type_name("CHAIN:NUMBER=STATE");
    prepare.add_option("--first", options.first, "at its first residue, or NONE")
        ->type_name("CHAIN=PATCH");
    prepare.add_option("--last", options.last, "at its last residue, or NONE")
        ->type_name("CHAIN=PATCH");
    prepare
        .add_option("--disulphide", options.disulphides,
                    "CHAIN:NUMBER-CHAIN:NUMBER: a bond beside those found")
        ->type_name("PAIR");
    add_negation(prepare, "--no-disulphides", settings.finds_disulphides, "look for none");
    prepare.add_flag("--keep-waters", settings.keeps_waters, "waters are left out otherwise");
    add_negation(prepare, "--no-ions", settings.keeps_ions, "ions are kept otherwise");
    prepare.add_option("--model", settings.model, "the first unless given");
    prepare
        .add_option("--assembly", settings.assembly,
                    "build this biological assembly of the file, often 1, by its symmetry; "
                    "unless given, what the file holds is taken as it is")
        ->check(in_range(1, 1e6));
    prepare
        .add_option("--altloc", options.alternates,
                    "CHAIN:NUMBER=LETTER: the location to take, not the most occupied")
        ->type_name("CHAIN:NUMBER=LETTER");
    add_negation(prepare, "--no-flips", settings.flips, "amides and imidazoles stay as they are");
    add_negation(prepare, "--no-relax", settings.relaxes,
                 "atoms stay where they are or were built");
    CLI::Option* const x_along =
        prepare
            .add_option("--x-along", options.x_along,
                        "segment whose long axis becomes x, its middle the origin")
            ->type_name("SEGMENT");
    prepare
        .add_option("--y-towards", options.y_towards,
                    "CHAIN:NUMBER-CHAIN:NUMBER: y from one residue to another; :NUMBER is the mean "
                    "of all chains")
        ->type_name("PAIR")
        ->needs(x_along);
    prepare
        .add_option("--grab", options.grab,
                    "what the hand holds in the scene: a SEGMENT, or SEGMENT:RESIDUE on a spring; "
                    "unless given, a small molecule or an exposed residue")
        ->type_name("WHAT");
    add_negation(prepare, "--no-scene", options.makes_scene, "no scene is made; takes less time");
    prepare.add_option("--title", options.title, "what the files say of themselves")
        ->type_name("TEXT");
    add_overwrite_flag(prepare, options.overwrites);
    prepare.add_flag("--json", options.json, "print counts and warnings as JSON");
}

void add_replay(CLI::App& program, palpa::ReplayOptions& options) {
    CLI::App& replay = *program.add_subcommand(
        "replay", "Plays a recorded session again; --verify demands the same to the last digit");
    palpa::describe(replay, "Experiments", {"palpa replay recordings/water --verify"});
    replay.add_option("recording", options.recording, "folder of palpa run --record")->required();
    replay.add_flag("--verify", options.verify,
                    "hold every row of the trace against what is found now; exit code 1 where one "
                    "differs");
    replay.add_flag("--json", options.json, "print the result as JSON");
}

void add_journey(CLI::App& program, palpa::JourneyOptions& options) {
    CLI::App& journey = *program.add_subcommand(
        "journey", "A molecule taken out of its pocket and brought back, by hand, period and mode");
    palpa::describe(journey, "Experiments",
                    {"palpa journey scenes/hiv/flexible.toml --periods 14 --hands medium"});
    journey.add_option("scene", options.scene, "flexible scene")->required();
    CLI::Option* const periods =
        journey
            .add_option("--periods", options.periods_ms, "declared T_s in ms, 1,14,83 unless given")
            ->delimiter(',')
            ->check(in_range(1, 1e4));
    CLI::Option* const fastest = journey.add_flag(
        "--fastest", options.fastest,
        "and at the shortest T_s that 99 % of steps keep on this machine, measured");
    CLI::Option* const hands =
        journey.add_option("--hands", options.grips, "medium,firm unless given")->delimiter(',');
    CLI::Option* const modes =
        journey.add_option("--modes", options.modes, "guarded,4 unless given")->delimiter(',');
    CLI::Option* const active =
        journey.add_option("--active", options.active, "degrees of freedom, 40 unless given")
            ->delimiter(',')
            ->check(in_range(0, 1e6));
    journey
        .add_option("--random", options.random,
                    "so many random hands, devices, periods, ways and numbers of active joints "
                    "instead")
        ->check(in_range(1, 1e6))
        ->excludes(periods)
        ->excludes(fastest)
        ->excludes(hands)
        ->excludes(modes)
        ->excludes(active);
    add_seed_option(journey, options.seed);
    journey.add_flag("--json", options.json, "print every journey as JSON");
    add_set_option(journey, options.settings);
}

void add_feel(CLI::App& program, palpa::FeelOptions& options) {
    CLI::App& feel = *program.add_subcommand(
        "feel", "A scene's stroke for ranges of forces to be felt and tolerances: what holds?");
    palpa::describe(feel, "Experiments",
                    {"palpa feel scenes/water --ranges 20:3000,50:400 --tolerances 0.001,1",
                     "palpa feel scenes/hiv/flexible.toml --ranges 500:20000 --tolerances 100,1000 "
                     "--samples 10"});
    feel.add_option("scene", options.scene, "scene folder or file")->required();
    feel.add_option("--ranges", options.ranges,
                    "WEAKEST:STRONGEST in pN, 20:3000,50:10000,200:5000 unless given")
        ->delimiter(',');
    feel.add_option("--tolerances", options.tolerances_pN, "pN, 50,150,500 unless given")
        ->delimiter(',')
        ->check(in_range(1e-6, 1e6));
    feel.add_option("--samples", options.samples,
                    "ticks of each stroke whose force is held against a reference, 20 unless given")
        ->check(in_range(1, 1e6));
    palpa::add_setting(feel, "--seconds", "length of the run", options.settings);
    feel.add_flag("--json", options.json, "print JSON");
    add_set_option(feel, options.settings);
}

void add_devices(CLI::App& program, palpa::DevicesOptions& options) {
    CLI::App& devices = *program.add_subcommand(
        "devices", "What is plugged in, what works, what is wrong and how to mend it");
    palpa::describe(
        devices, "Feel", {"palpa devices", "palpa devices omni --force-test"},
        "Exit code 0 if there is a device that can be used, emulated ones beside, else 1.");
    devices.add_option("device", options.name,
                       "as --device of palpa run takes it; all unless given");
    devices.add_flag("--force-test", options.tests_force, "push the handle a little, after asking");
    CLI::Option* const json = devices.add_flag("--json", options.json, "print the result as JSON");
    devices
        .add_flag("--latency", options.times_latency,
                  "time emulated devices instead, from their report to the force")
        ->excludes(json);
}

void add_relax(CLI::App& program, palpa::RelaxOptions& options) {
    CLI::App& relax =
        *program.add_subcommand("relax", "Bring the flexible molecules of a scene to rest");
    palpa::describe(relax, "Make scenes", {"palpa relax scenes/hiv/flexible.toml -o rest.crd"});
    relax.add_option("scene", options.scene, "scene folder or file")->required();
    relax.add_option("-o,--output", options.coordinates,
                     "CHARMM coordinates (.crd) to write: where they rest");
    add_overwrite_flag(relax, options.overwrites);
    relax.add_flag("--json", options.json, "print JSON");
    add_set_option(relax, options.settings);
}

void add_scenarios(CLI::App& program, palpa::ScenarioOptions& options) {
    CLI::App& scenarios = *program.add_subcommand(
        "scenarios", "Random hands and devices on a scene of one axis: does any vibrate?");
    palpa::describe(scenarios, "Experiments", {"palpa scenarios scenes/water --count 100"});
    scenarios.add_option("scene", options.scene, "scene folder or file")->required();
    scenarios.add_option("--count", options.count, "10000 unless given")->check(in_range(1, 1e7));
    scenarios.add_option("--first", options.first, "number of the first, 0 unless given")
        ->check(in_range(0, 1e12));
    add_seed_option(scenarios, options.seed);
    scenarios.add_flag("--json", options.json, "print every scenario as JSON");
    add_set_option(scenarios, options.settings);
}

void add_report(CLI::App& program, palpa::ReportOptions& options) {
    CLI::App& report = *program.add_subcommand(
        "report", "The paper's figures, the acceptance bars and more, computed anew: one page");
    palpa::describe(report, "Experiments", {"palpa report -o report.html"});
    report.add_option("-o,--output", options.output, "page to write, report.html unless given");
    add_overwrite_flag(report, options.overwrites);
    report.add_option("--scene", options.scene, "of one axis, scenes/water unless given");
    report
        .add_option(
            "--hiv", options.flexible,
            "flexible scene, scenes/hiv/flexible.toml unless given; left out where that is not "
            "there")
        ->check(CLI::ExistingPath);
    report.add_flag("--quick", options.quick, "fewer and shorter runs: half a minute");
    add_seed_option(report, options.seed);
    add_set_option(report, options.settings);
}

void add_loops(CLI::App& program, palpa::LoopOptions& options) {
    CLI::App& loops = *program.add_subcommand(
        "loops", "Random closed ways of hands in space: does the coupling give or take energy?");
    palpa::describe(loops, "Experiments", {"palpa loops scenes/water/space.toml --count 100"});
    loops.add_option("scene", options.scene, "scene folder or file")->required();
    loops.add_option("--count", options.count, "1000 unless given")->check(in_range(1, 1e7));
    loops.add_option("--first", options.first, "number of the first, 0 unless given")
        ->check(in_range(0, 1e12));
    add_seed_option(loops, options.seed);
    loops.add_flag("--json", options.json, "print every loop as JSON");
    loops.add_flag("--turn", options.turn, "the handle turns on its way (molecules with-handle)");
    add_set_option(loops, options.settings);
}

void add_study(CLI::App& program, palpa::ForcedChoiceOptions& choice, bool& is_choice) {
    palpa::StudyOptions& options = choice.study;
    CLI::App& study = *program.add_subcommand(
        "study", "The paper's experiment: who finds the place without force in which mode?");
    palpa::describe(
        study, "Experiments",
        {"palpa study scenes/water --operators 20", "palpa study scenes/water -o people",
         "palpa study scenes/water --operators 20 --hand firm --modes 2,4,guarded -o study",
         "palpa study scenes/water --operators 5 --forced-choice attracts-more --modes 2,4"});
    study.add_option("scene", options.scene, "scene folder or file of one axis")->required();
    options.operators = 0;
    CLI::Option* const operators =
        study
            .add_option("--operators", options.operators,
                        "emulated ones, headless; without them a person takes part, in a window")
            ->check(in_range(1, 1e6));
    CLI::Option* const rounds =
        study.add_option("--rounds", options.rounds, "each with every mode once, 3 unless given")
            ->check(in_range(1, 999));
    study.add_option_function<std::string>(
        "--modes",
        [&options](const std::string& names) { options.modes = palpa::modes_called(names); },
        "1 to 5 and guarded, with commas between; all unless given");
    CLI::Option* const manner = study.add_option_function<std::string>(
        "--operator",
        [&options](const std::string& name) { options.manner = palpa::manner_called(name); },
        "naive: follows the force; careful: then takes the middle of the range without force "
        "(naive unless given)");
    CLI::Option* const question = study.add_option_function<std::string>(
        "--forced-choice",
        [&](const std::string& name) {
            choice.question = palpa::question_called(name);
            is_choice = true;
        },
        "stiffer or attracts-more, instead: of two molecules, one with all forces larger, which "
        "is it?");
    question->excludes(rounds)->excludes(manner)->needs(operators);
    manner->needs(operators);
    study.add_option("--repeats", choice.repeats, "of each pair, 10 unless given")
        ->check(in_range(1, 1e6))
        ->needs(question);
    study.add_option("--limit", options.limit_s, "seconds for a trial, 90 unless given")
        ->check(in_range(1, 3600))
        ->needs(operators)
        ->excludes(question);
    add_seed_option(study, options.seed);
    study.add_option("-o,--output", options.folder,
                     "new folder for trials.csv, summary.json and line.csv; of forced choices for "
                     "choices.csv and summary.json; of people, each of whom adds to it, for "
                     "trials.csv, session.json and line.csv");
    study.add_flag("--json", options.json, "print the summary as JSON")->needs(operators);
    study
        .add_flag("--validation", options.validation,
                  "let the Vulkan validation layer watch the window's drawing")
        ->excludes(operators);
    palpa::add_setting(study, "--period-ms", "declared period of the simulation, 14 unless given",
                       options.settings);
    palpa::add_setting(study, "--hand", "light, slack, medium, firm or firm-grip",
                       options.settings);
    palpa::add_setting(study, "--friction", "Coulomb friction of the device", options.settings);
    add_set_option(study, options.settings);
}

int run_program(const std::vector<std::string>& arguments) {
    CLI::App program("Palpa: feel molecules", "palpa");
    program.formatter(palpa::build_help_formatter());
    program.set_help_flag("-h,--help", "print this");
    program.set_version_flag("--version",
                             std::string(palpa::version_name) + " (" + palpa::commit_name + ")");
    palpa::RunOptions run;
    palpa::BenchOptions bench;
    palpa::RenderOptions render;
    palpa::EnergyOptions energy;
    palpa::PrepareOptions prepare;
    palpa::RelaxOptions relax;
    palpa::ScenarioOptions scenarios;
    palpa::LoopOptions loops;
    palpa::ReportOptions report;
    palpa::ForcedChoiceOptions choice;
    bool is_choice = false;
    palpa::FeelOptions feel;
    palpa::DevicesOptions devices;
    palpa::JourneyOptions journey;
    palpa::ReplayOptions replay;
    // In the order of the help.
    add_run(program, run);
    add_devices(program, devices);
    add_prepare(program, prepare);
    add_relax(program, relax);
    add_render(program, render);
    add_energy(program, energy);
    add_bench(program, bench);
    add_report(program, report);
    add_study(program, choice, is_choice);
    add_replay(program, replay);
    add_scenarios(program, scenarios);
    add_loops(program, loops);
    add_feel(program, feel);
    add_journey(program, journey);
    if (arguments.empty()) return palpa::start_command();
    if (const auto unknown = palpa::explain_command(program, arguments[0])) {
        fmt::print(stderr, "{}\n", *unknown);
        return bad_input;
    }
    try {
        program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::CallForVersion&) {
        fmt::print("{} ({})\n", palpa::version_name, palpa::commit_name);
        return 0;
    } catch (const CLI::Success& success) {  // --help
        return program.exit(success);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "{}\n", palpa::explain(error, program, arguments[0]));
        return bad_input;
    }
    if (program.got_subcommand("devices")) return palpa::devices_command(devices);
    if (program.got_subcommand("energy")) return palpa::energy_command(energy);
    if (program.got_subcommand("prepare")) return palpa::prepare_command(prepare);
    if (program.got_subcommand("relax")) return palpa::relax_command(relax);
    if (program.got_subcommand("scenarios")) return palpa::scenarios_command(scenarios);
    if (program.got_subcommand("feel")) return palpa::feel_command(feel);
    if (program.got_subcommand("journey")) return palpa::journey_command(journey);
    if (program.got_subcommand("replay")) return palpa::replay_command(replay);
    if (program.got_subcommand("loops")) return palpa::loops_command(loops);
    if (program.got_subcommand("report")) return palpa::report_command(report);
    if (program.got_subcommand("study"))
        return is_choice ? palpa::forced_choice_command(choice)
                         : palpa::study_command(choice.study);
    if (program.got_subcommand("render")) return palpa::render_command(render);
    return program.got_subcommand("run") ? palpa::run_command(run) : palpa::bench_command(bench);
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments = palpa::expand_help({argv + 1, argv + argc});
    try {
        const int code = run_program(arguments);
        if (std::fflush(stdout) == 0) return code;
        fmt::print(stderr, "palpa: the output cannot be written\n");
        return bad_input;
    } catch (const std::system_error&) {  // what fmt throws when it cannot print
        fmt::print(stderr, "palpa: the output cannot be written\n");
        return bad_input;
    } catch (const palpa::PlatformError& error) {
        fmt::print(stderr, "palpa: {}\n", error.what());
        return bad_input;
    } catch (const palpa::GpuError& error) {
        fmt::print(stderr, "palpa: {}\n", error.what());
        return bad_input;
    } catch (const palpa::LoadError& error) {
        fmt::print(stderr, "{}\n", palpa::cite_as_typed(error.what(), arguments));
        for (const std::string& problem : error.further()) fmt::print(stderr, "{}\n", problem);
        return bad_input;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr,
                   "palpa: not enough memory for this; expected a smaller file, molecule or "
                   "picture\n");
        return bad_input;
    } catch (const std::exception& error) {
        fmt::print(stderr, "palpa: internal error: {}\n", error.what());
        return own_fault;
    }
}
