#include "experiments/make_scene.h"

#include "charmm/built_in_force_field.h"
#include "charmm/force_field.h"
#include "charmm/penalties.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "formats/psf.h"
#include "formats/structure.h"
#include "scene/find_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

ForceField read_wanted_force_field(const SceneRequest& request) {
    if (!request.only_these_files) return read_built_in_force_field(request.force_field);
    return read_force_field(request.force_field);
}

void report_force_field(const ForceField& force_field, Report& report) {
    constexpr std::string_view heading = "Force field";
    for (const std::string& line : force_field.about) report.add(heading, line);
    const auto& files = force_field.files;
    for (std::size_t i = force_field.about.empty() ? 0 : 1; i < files.size(); ++i) {
        report.add(heading, std::filesystem::path(files[i]).filename().string());
    }
    for (std::string& line : describe_notes(force_field.notes)) report.warn(std::move(line));
}

// What the CGenFF program says of its own parameters.
void report_penalties(const std::vector<std::filesystem::path>& files, Report& report) {
    for (const std::filesystem::path& file : files) {
        for (const CgenffPenalties& one : find_penalties(read_text_file(file))) {
            const double highest = std::max(one.parameters, one.charges);
            std::string text = fmt::format(
                "{} of {}: highest CGenFF penalties: {:.1f} for parameters, {:.1f} for charges",
                one.residue, file.filename().string(), one.parameters, one.charges);
            if (highest < fair_penalty) {
                report.add("Ligand parameters", std::move(text));
            } else {
                report.warn(text + (highest < poor_penalty ? "; validate them before you measure"
                                                           : "; they are poor: optimise them"));
            }
        }
    }
}

TunedScene find_scene(const SceneRequest& request, const std::string& title,
                      const StageFunction& on_stage, PreparedSystem& system) {
    if (!request.makes_scene) return {};
    try {
        const std::string name =
            request.title.empty() ? name_of_structure(request.structure).string() : request.title;
        return tune_scene(system, request.grab, request.settings.align.has_value(),
                          request.measures, printable(name), title, on_stage);
    } catch (const LoadError& error) {
        if (!request.grab.empty() && request.measures) throw;  // a window offers what is there
        system.report.warn(fmt::format("no scene was written: {}", error.what()));
        return {};
    }
}

}  // namespace

MadeScene prepare_request(const SceneRequest& request, const StageFunction& on_stage) {
    tell(on_stage, for_translation("reading the force field"));
    const ForceField force_field = read_wanted_force_field(request);
    tell(on_stage, for_translation("reading the structure"));
    const Structure structure = read_structure(request.structure);
    MadeScene made;
    if (request.topology.empty()) {
        made.system = prepare_system(force_field, structure, request.settings, on_stage);
    } else {
        made.system = adopt_system(force_field, read_psf(request.topology), structure);
    }
    report_force_field(force_field, made.system.report);
    report_penalties(request.force_field, made.system.report);
    const std::string origin = fmt::format("Prepared from {} by palpa prepare; see report.txt.",
                                           request.structure.filename().string());
    made.title = request.title.empty() ? origin : fmt::format("{}\n{}", request.title, origin);
    return made;
}

void add_scene(const SceneRequest& request, const StageFunction& on_stage, MadeScene& made) {
    made.scene = find_scene(request, made.title, on_stage, made.system);
}

MadeScene make_scene(const SceneRequest& request, const StageFunction& on_stage) {
    MadeScene made = prepare_request(request, on_stage);
    add_scene(request, on_stage, made);
    return made;
}

}  // namespace palpa
