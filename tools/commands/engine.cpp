#include "tools/commands/engine.h"

#include "charmm/build_topology.h"
#include "charmm/force_field.h"
#include "charmm/used_parameters.h"
#include "charmm/write_parameters.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/shell_word.h"
#include "core/text.h"
#include "formats/crd.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "inputs/gromacs.h"
#include "inputs/lammps.h"
#include "inputs/water_box.h"
#include "loading/load.h"
#include "molecule/match_atoms.h"
#include "scene/read_scene.h"
#include "tools/commands/command.h"
#include "tools/commands/force_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

// Stands near the beginning of what is written, by which it is known again.
constexpr std::string_view engine_mark = "palpa engine";

struct GivenSystem {
    Connectivity connectivity;
    std::vector<Vec3> positions;
    ForceField force_field;
};

// --psf, --coordinates, --toppar.
GivenSystem read_given(const EngineOptions& options) {
    GivenSystem given{read_psf(*options.psf), {}, read_force_field(expand_folders(options.toppar))};
    given.positions = match_positions(given.connectivity, read_structure(*options.coordinates));
    return given;
}

std::optional<Vec3> read_box(const std::string& text) {
    if (text.empty()) return std::nullopt;
    Vec3 box;
    std::size_t begin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t end = axis < 2 ? text.find(',', begin) : text.size();
        const auto edge = end == std::string::npos
                              ? std::nullopt
                              : find_real(std::string_view(text).substr(begin, end - begin));
        if (!edge || *edge <= 0 || *edge > 1e5) {
            throw LoadError(
                {"--box " + text},
                "expected three edges in Å separated by commas, such as 18.6,18.6,18.6");
        }
        box[axis] = *edge;
        begin = end + 1;
    }
    return box;
}

RunSystem read_system(const EngineOptions& options) {
    RunSystem system;
    if (!options.psf) {
        const SceneDescription scene = read_scene(options.scene, options.settings);
        SceneSystem read = load_system(scene);
        system.title = scene.title;
        system.connectivity = std::move(read.connectivity);
        system.topology = std::move(read.topology);
        system.positions = std::move(read.positions);
        system.coulomb_constant = scene.force_field.coulomb_constant;
        if (system.connectivity.file.empty()) system.connectivity.file = scene.file.string();
    } else {
        GivenSystem given = read_given(options);
        system.title = printable(options.psf->filename().string());
        system.topology = build_topology(given.connectivity, given.force_field);
        system.connectivity = std::move(given.connectivity);
        system.positions = std::move(given.positions);
    }
    system.box = read_box(options.box);
    return in_run_order(system);
}

void check_choice(const EngineOptions& options) {
    const bool has_all = options.psf && options.coordinates && !options.toppar.empty();
    const bool has_any = options.psf || options.coordinates || !options.toppar.empty();
    if (has_any && !has_all) {
        throw LoadError({"palpa engine"},
                        "expected --psf, --coordinates and --toppar together, or a scene");
    }
    if (has_all != options.scene.empty()) {
        throw LoadError({"palpa engine"},
                        "expected a scene, or --psf, --coordinates and --toppar instead of it");
    }
}

// Atoms of the segments that are asked for.
std::vector<std::uint32_t> find_sent(const EngineOptions& options, const RunSystem& system) {
    std::vector<std::uint32_t> sent;
    std::vector<std::string_view> segments;
    for (std::uint32_t atom = 0; atom < system.connectivity.names.size(); ++atom) {
        const std::string& segment = system.connectivity.names[atom].segment;
        if (segments.empty() || segments.back() != segment) segments.push_back(segment);
        if (std::ranges::find(options.send, segment) != options.send.end()) sent.push_back(atom);
    }
    for (const std::string& asked : options.send) {
        if (std::ranges::find(segments, asked) != segments.end()) continue;
        throw LoadError({"--send " + asked}, fmt::format("there is no segment of this name{}",
                                                         near_name_hint(asked, segments)));
    }
    return sent;
}

std::string format_coordinates(const Connectivity& connectivity, std::vector<Vec3> positions,
                               std::string_view title) {
    Structure structure;
    structure.file = connectivity.file;
    structure.names = connectivity.names;
    structure.positions = std::move(positions);
    return format_crd(structure, title);
}

// PSF and coordinates of what a client sees: atoms in the order in which the engine sends them.
void add_topology(const RunSystem& system, const std::vector<Vec3>& positions,
                  const std::vector<std::uint32_t>& sent, std::vector<TextFile>& files) {
    const std::string title = system.title + "\nWritten by palpa engine.";
    files.push_back({"system.psf", format_psf(system.connectivity, title)});
    files.push_back({"system.crd", format_coordinates(system.connectivity, positions, title)});
    if (sent.empty()) return;
    Connectivity part;
    part.file = system.connectivity.file;
    append_atoms(system.connectivity, sent, part);
    std::vector<Vec3> places;
    for (const std::uint32_t atom : sent) places.push_back(positions[atom]);
    files.push_back({"sent.psf", format_psf(part, title)});
    files.push_back({"sent.crd", format_coordinates(part, std::move(places), title)});
}

void write_folder(const EngineOptions& options, std::vector<TextFile> files) {
    make_folder(options.folder);
    for (TextFile& file : files) {
        file.path = options.folder / file.path;
        file.existing = check_output(file.path, engine_mark, options.overwrites);
    }
    write_text_files(files);
}

int write_input(const EngineOptions& options) {
    const RunSystem system = read_system(options);
    const bool is_gromacs = options.what == "gromacs";
    EngineRunOptions run = options.run;
    run.sent = find_sent(options, system);
    std::vector<TextFile> files =
        is_gromacs ? format_gromacs(system, run) : format_lammps(system, run);
    add_topology(system, is_gromacs ? gromacs_positions(system) : system.positions, run.sent,
                 files);
    write_folder(options, std::move(files));
    for (const std::string& warning : list_warnings(system))
        fmt::print(stderr, "warning: {}\n", warning);
    if (system.box && is_gromacs) {
        if (const Cutoff cutoff = gromacs_cutoff(system); cutoff.to < 12) {
            fmt::print(stderr,
                       "warning: the box is too small for CHARMM36's cutoff of 12 Å; {:.1f} Å is "
                       "used instead\n",
                       cutoff.to);
        }
    }
    const std::string folder = options.folder.string();
    fmt::print(
        "{} atoms, {}: {}\nstart it:      sh {}\nconnect to it: palpa connect 127.0.0.1:{} "
        "--topology {}\n",
        system.positions.size(), system.box ? "in a box" : "in vacuum", folder,
        shell_word(folder + "/run.sh"), run.port,
        shell_word(folder + (run.sent.empty() ? "/system.psf" : "/sent.psf")));
    return 0;
}

// --waters as cubes of eight along each edge.
std::size_t cells_per_edge(const EngineOptions& options) {
    const auto cells =
        static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(options.waters) / 8)));
    if (cells >= 1 && 8 * cells * cells * cells == options.waters) return cells;
    throw LoadError({fmt::format("--waters {}", options.waters)},
                    "expected 8 times a cube number: 64, 216, 512, 1000, 1728, ...");
}

int write_box(const EngineOptions& options) {
    if (!options.scene.empty() || !options.box.empty() || !options.send.empty()) {
        throw LoadError({"palpa engine box"},
                        "does not take a scene; expected --waters, or --psf with --coordinates");
    }
    if (options.toppar.empty() || options.psf.has_value() != options.coordinates.has_value()) {
        throw LoadError({"palpa engine box"},
                        "expected --toppar, and --psf and --coordinates together or neither");
    }
    GivenSystem given;
    if (options.psf) {
        given = read_given(options);
    } else {
        given.force_field = read_force_field(expand_folders(options.toppar));
        given.connectivity.file = options.toppar.back().string();
    }
    WaterBoxSettings settings;
    settings.cells = cells_per_edge(options);
    const WaterBox box =
        build_water_box(given.force_field, given.connectivity, given.positions, settings);
    const std::string edges = fmt::format("{0:.4f},{0:.4f},{0:.4f}", box.edge);
    const std::string title =
        fmt::format("{} waters{} in a box of {} A.\nWritten by palpa engine.", box.waters,
                    options.psf ? " and " + printable(options.psf->stem().string()) : "", edges);
    const ForceField used = keep_used_parameters(given.force_field, box.connectivity);
    write_folder(options,
                 {{"system.psf", format_psf(box.connectivity, title)},
                  {"system.crd", format_coordinates(box.connectivity, box.positions, title)},
                  {"system.prm", format_parameters(used, title)}});
    const std::string folder = options.folder.string();
    fmt::print("{} waters, {} atoms: {}\n", box.waters, box.positions.size(), folder);
    if (box.edge < shortest_gromacs_edge) {
        fmt::print(
            "its edge of {:.2f} Å is too short for a run: GROMACS needs {} Å; give more --waters\n",
            box.edge, shortest_gromacs_edge);
        return 0;
    }
    fmt::print(
        "make the input of a run: palpa engine gromacs -o {} --box {} --psf {} --coordinates {} "
        "--toppar {}\n",
        shell_word(folder + "-run"), edges, shell_word(folder + "/system.psf"),
        shell_word(folder + "/system.crd"), shell_word(folder + "/system.prm"));
    return 0;
}

}  // namespace

int engine_command(const EngineOptions& options) {
    if (options.what == "box") return write_box(options);
    check_choice(options);
    return write_input(options);
}

void add_engine(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& engine = *program.add_subcommand(
        "engine", "Write the input of a GROMACS or LAMMPS run that Palpa can connect to");
    EngineOptions& options = own_options<EngineOptions>(engine, chosen, engine_command);
    describe(engine,
             {"palpa engine gromacs scenes/hairpin/vacuum.toml -o run",
              "palpa engine gromacs -o run --box 18.64,18.64,18.64 --psf system.psf --coordinates "
              "system.crd --toppar system.prm",
              "palpa engine box -o box --psf system.psf --coordinates system.crd --toppar "
              "system.prm tip3p.str"});
    engine
        .add_option("what", options.what,
                    "gromacs, lammps, or box (a box of water, with or without a system in it)")
        ->required()
        ->check(CLI::IsMember({"gromacs", "lammps", "box"}));
    engine.add_option("scene", options.scene, "scene folder or file");
    engine.add_option("--psf", options.psf, "PSF file of a system, in place of a scene")
        ->type_name("FILE");
    engine
        .add_option("--coordinates", options.coordinates,
                    "coordinates for --psf: .crd, .pdb or .cif")
        ->type_name("FILE");
    engine.add_option("--toppar", options.toppar, "topology and parameter files for --psf")
        ->type_name("FILE ...");
    engine.add_option("--box", options.box, "edges of a periodic box, Å (default: vacuum)")
        ->type_name("A,B,C");
    engine
        .add_option(
            "--send", options.send,
            "segments whose atoms the engine sends and the hand may pull (default: all atoms)")
        ->delimiter(',')
        ->type_name("SEGMENT,...");
    engine.add_option("--port", options.run.port, "port where the engine waits for Palpa")
        ->check(in_range(1, 65535))
        ->capture_default_str();
    engine.add_option("--temperature", options.run.temperature, "temperature, K (default 300)")
        ->check(in_range(0, 1e4));
    engine
        .add_option("--timestep", options.run.timestep,
                    "time step, fs (default 2, with --flexible 1)")
        ->check(in_range(0.001, 10));
    engine.add_flag("--flexible", options.run.flexible,
                    "flexible bonds and waters (default: bonds to hydrogens and waters are rigid)");
    engine.add_option("--steps", options.run.steps, "number of steps (default: until you end it)")
        ->check(in_range(0, 1e12));
    engine
        .add_option("--waters", options.waters,
                    "number of waters of a box before those that overlap the system are removed; 8 "
                    "times a cube number")
        ->capture_default_str();
    engine.add_option("-o,--output", options.folder, "folder for the files")->required();
    add_overwrite_flag(engine, options.overwrites);
    add_set_option(engine, options.settings);
}

}  // namespace palpa
