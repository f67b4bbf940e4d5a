#include "tools/commands/relax.h"

#include "core/files.h"
#include "core/text.h"
#include "formats/crd.h"
#include "loading/load.h"
#include "molecule/coincident_atoms.h"
#include "scene/read_scene.h"
#include "session/compare_poses.h"
#include "simulation/grip_queries.h"
#include "tools/commands/command.h"
#include "tools/commands/progress.h"

#include <fmt/format.h>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

// In the order of RelaxEnd.
constexpr std::array<std::string_view, 4> end_names{
    "at rest", "not at rest: more steps are needed (statics.relax_steps)",
    "the energy cannot be lowered further", "not finite"};

std::string_view end_of(const JointRelaxReport& report) {
    return end_names[static_cast<std::size_t>(report.end)];
}

// How far molecules are at rest from where their files have them.
struct FromFiles {
    PoseDistance distance;
    std::size_t pocket_residues = 0;
};

FromFiles compare_with_files(const SceneDescription& scene, const World& world) {
    World start = world;
    std::vector<Vec3>& positions = start.write<AtomTable>().positions;
    positions = load_system(scene).positions;
    const PoseComparison comparison(start);
    return {comparison.between(reference_positions(world), positions),
            comparison.pocket_residues()};
}

void print_report(const StartReport& start, const FromFiles& from) {
    const JointRelaxReport& r = start.joints_at_rest.value();
    fmt::print("{} joints: {:.4f} to {:.4f} kcal/mol, rms force {:.3g} kcal/mol per radian and Å\n",
               start.joints, r.energy_before, r.energy_after, r.rms_force);
    fmt::print("{} steps, {} evaluations, largest move {:.3f} Å; {}\n", r.steps, r.evaluations,
               r.largest_move, end_of(r));
    const PoseDistance& d = from.distance;
    fmt::print(
        "rms displacement from the files: what the hand holds {:.3f} Å, backbone {:.3f} Å, side "
        "chains of the {} residues around it {:.3f} Å\n",
        d.held, d.backbone, from.pocket_residues, d.pocket);
}

void print_json(const StartReport& start, const FromFiles& from) {
    const JointRelaxReport& r = start.joints_at_rest.value();
    const nlohmann::ordered_json json{{"joints", start.joints},
                                      {"energy_before", r.energy_before},
                                      {"energy_after", r.energy_after},
                                      {"rms_force", r.rms_force},
                                      {"steps", r.steps},
                                      {"evaluations", r.evaluations},
                                      {"largest_move", r.largest_move},
                                      {"end", end_of(r)},
                                      {"held_rmsd_angstrom", from.distance.held},
                                      {"backbone_rmsd_angstrom", from.distance.backbone},
                                      {"pocket_rmsd_angstrom", from.distance.pocket},
                                      {"pocket_residues", from.pocket_residues}};
    fmt::print("{}\n", json.dump(2));
}

// Stands in the title of what is written, by which it is known again.
constexpr std::string_view relaxed_mark = "* Written by palpa relax.\n";

}  // namespace

int relax_command(const RelaxOptions& options) {
    SceneDescription scene = read_scene(options.scene, options.settings);
    scene.statics.relaxes_start = true;  // also one that was saved
    print_notes(scene.notes);
    const Existing existing =
        options.coordinates ? check_output(*options.coordinates, relaxed_mark, options.overwrites)
                            : Existing::Refuse;
    ProgressLine progress;
    const World world = load_world(scene, progress.stages());
    progress.wipe();
    if (!has_mobile(world)) {
        throw LoadError({scene.file.string()},
                        "no molecule of this scene moves by itself; expected one with shape = "
                        "\"flexible\" or motion = \"free\"");
    }
    const StartReport& start = world.resource<StartReport>();
    const JointRelaxReport& relaxed = start.joints_at_rest.value();
    if (options.coordinates) {
        Structure structure;
        structure.names = world.resource<AtomTable>().names;
        structure.weights = world.resource<AtomTable>().b_factor;
        structure.positions = reference_positions(world);
        write_text_file(
            *options.coordinates,
            format_crd(structure,
                       fmt::format("Written by palpa relax.\n{}: relaxed, {} joints, rms force "
                                   "{:.3g} kcal/mol per radian and angstrom",
                                   scene.title, start.joints, relaxed.rms_force)),
            existing);
    }
    if (const auto closest =
            describe_coincident_atoms(world.resource<AtomTable>().names, reference_positions(world),
                                      nearest_single_precision)) {
        fmt::print(stderr, "warning: atoms overlap: {}\n", printable(*closest));
    }
    const FromFiles from = compare_with_files(scene, world);
    options.json ? print_json(start, from) : print_report(start, from);
    return relaxed.end == RelaxEnd::Converged ? 0 : 1;
}

void add_relax(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& relax = *program.add_subcommand("relax", "Relax the flexible molecules of a scene");
    RelaxOptions& options = own_options<RelaxOptions>(relax, chosen, relax_command);
    describe(relax, {"palpa relax scenes/hiv/flexible.toml -o rest.crd"});
    relax.add_option("scene", options.scene, "scene folder or file")->required();
    relax.add_option("-o,--output", options.coordinates,
                     "write the relaxed coordinates to this CHARMM file (.crd)");
    add_overwrite_flag(relax, options.overwrites);
    relax.add_flag("--json", options.json, "print JSON");
    add_set_option(relax, options.settings);
}

}  // namespace palpa
