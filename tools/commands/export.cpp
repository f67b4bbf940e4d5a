// palpa export: coordinates of a scene for other programs.
#include "core/files.h"
#include "core/load_error.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/coordinates.h"
#include "session/run_headless.h"
#include "tools/commands/command.h"
#include "tools/commands/progress.h"

#include <fmt/format.h>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpa {
namespace {

struct ExportOptions {
    std::filesystem::path scene, file;
    std::vector<std::string> settings, molecules;
    double time_s = 0;  // simulated, under the emulated hand, before
    bool overwrites = false;
};

int export_command(const ExportOptions& options) {
    SceneDescription scene = read_scene(options.scene, options.settings);
    print_notes(scene.notes);
    refuse_remote_engine(scene);
    std::vector<Existing> existing;
    for (const std::filesystem::path& file : list_coordinate_files(options.file))
        existing.push_back(check_output(file, coordinates_mark(file), options.overwrites));
    ProgressLine progress;
    World world = load_world(scene, progress.stages());
    const std::vector<std::uint32_t> atoms = select_atoms(world, options.molecules);
    // Names that do not fit the format are refused before the long work.
    (void)format_coordinates(world, atoms, options.file, scene.title);
    if (options.time_s > 0) {
        scene.seconds = options.time_s;
        EmulatedOmni device(build_emulated_omni(scene, world));
        run_headless(scene, world, device, {}, nullptr, progress.shares("playing"));
    }
    const std::vector<std::uint32_t> now = select_atoms(world, options.molecules);
    std::vector<TextFile> files = format_coordinates(
        world, now, options.file, fmt::format("{}, after {} s", scene.title, options.time_s));
    for (std::size_t i = 0; i < files.size(); ++i) files[i].existing = existing[i];
    write_text_files(files);
    progress.wipe();
    for (const TextFile& file : files) fmt::print("{}: {} atoms\n", file.path.string(), now.size());
    return 0;
}

}  // namespace

void add_export(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& command =
        *program.add_subcommand("export", "Write coordinates of a scene for other programs");
    ExportOptions& options = own_options<ExportOptions>(command, chosen, export_command);
    describe(command, {"palpa export scenes/hiv -o hiv.pdb", "palpa export hiv -o hiv.psf --time 2",
                       "palpa export scenes/water -o moved.gro --of moved"});
    command.add_option("scene", options.scene, "scene folder or file")->required();
    command
        .add_option("-o,--output", options.file,
                    "file to write, format by its ending: .pdb, .cif, .gro, .crd, or .psf with a "
                    ".crd beside it")
        ->type_name("FILE")
        ->required();
    command
        .add_option_function<std::string>(
            "--of", [&options](const std::string& name) { options.molecules.push_back(name); },
            "a molecule of the scene; repeat for several (default: all that is shown)")
        ->type_name("MOLECULE")
        ->trigger_on_parse()
        ->take_last();
    command.add_option("--time", options.time_s, "simulated seconds to play before, s")
        ->check(in_range(0.0, 1e5));
    add_overwrite_flag(command, options.overwrites);
    add_set_option(command, options.settings);
}

}  // namespace palpa
