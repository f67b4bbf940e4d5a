#include "tools/relax.h"

#include "core/files.h"
#include "core/text.h"
#include "formats/crd.h"
#include "molecule/coincident_atoms.h"
#include "scene/read_scene.h"
#include "simulation/simulation.h"
#include "tools/progress.h"

#include <fmt/format.h>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>

namespace palpa {
namespace {

// In the order of RelaxEnd.
constexpr std::array<std::string_view, 4> end_names{
    "at rest", "not at rest: more steps would go on", "nothing lowers the energy any more",
    "not finite"};

std::string_view end_of(const JointRelaxReport& report) {
    return end_names[static_cast<std::size_t>(report.end)];
}

void print_report(const Flexible& flexible) {
    const JointRelaxReport& r = flexible.relaxed;
    fmt::print("{} joints: {:.4f} to {:.4f} kcal/mol, rms force {:.3g} kcal/mol per radian and Å\n",
               flexible.joints, r.energy_before, r.energy_after, r.rms_force);
    fmt::print("{} steps, {} evaluations, moved {:.3f} Å at most; {}\n", r.steps, r.evaluations,
               r.largest_move, end_of(r));
}

void print_json(const Flexible& flexible) {
    const JointRelaxReport& r = flexible.relaxed;
    const nlohmann::ordered_json json{{"joints", flexible.joints},
                                      {"energy_before", r.energy_before},
                                      {"energy_after", r.energy_after},
                                      {"rms_force", r.rms_force},
                                      {"steps", r.steps},
                                      {"evaluations", r.evaluations},
                                      {"largest_move", r.largest_move},
                                      {"end", end_of(r)}};
    fmt::print("{}\n", json.dump(2));
}

// Stands in the title of what is written, by which it is known again.
constexpr std::string_view coordinates_mark = "* Written by palpa relax.\n";

}  // namespace

int relax_command(const RelaxOptions& options) {
    const SceneDescription scene = read_scene(options.scene, options.settings);
    const Existing existing =
        options.coordinates
            ? check_output(*options.coordinates, coordinates_mark, options.overwrites)
            : Existing::Refuse;
    ProgressLine progress;
    const Simulation simulation = load_simulation(scene, progress.stages());
    progress.wipe();
    if (!simulation.flexible) {
        throw LoadError({scene.file.string()},
                        "nothing moves by itself here; expected a molecule with shape = "
                        "\"flexible\" or motion = \"free\"");
    }
    const Flexible& flexible = *simulation.flexible;
    if (options.coordinates) {
        Structure structure;
        structure.names = simulation.atoms.names;
        structure.positions = flexible.model.reference;
        write_text_file(
            *options.coordinates,
            format_crd(structure,
                       fmt::format("Written by palpa relax.\n{}: relaxed, {} joints, rms force "
                                   "{:.3g} kcal/mol per radian and angstrom",
                                   scene.title, flexible.joints, flexible.relaxed.rms_force)),
            existing);
    }
    if (const auto closest = describe_coincident_atoms(
            simulation.atoms.names, flexible.model.reference, nearest_single_precision)) {
        fmt::print(stderr, "warning: atoms are on each other: {}\n", printable(*closest));
    }
    options.json ? print_json(flexible) : print_report(flexible);
    return flexible.relaxed.end == RelaxEnd::Converged ? 0 : 1;
}

}  // namespace palpa
