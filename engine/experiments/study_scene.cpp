#include "experiments/study_scene.h"

#include "core/load_error.h"
#include "core/units.h"
#include "devices/emulated_hand.h"
#include "devices/emulated_omni.h"
#include "haptics/hand.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"

#include <fmt/format.h>

namespace palpa {
namespace {

constexpr double nN = units::newton_per_kcal_per_mol_angstrom * 1e9;

// Forces beyond feel the same whatever they are, so a hand that got there went through the wall.
constexpr double through_nN = 100;

}  // namespace

SceneDescription read_study_scene(const StudyOptions& options,
                                  const std::vector<std::string>& trial_settings) {
    std::vector<std::string> settings{fmt::format("run.period_ms={}", study_period_ms)};
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
    settings.insert(settings.end(), trial_settings.begin(), trial_settings.end());
    return read_scene(options.scene, settings);
}

double find_rest(const SceneDescription& scene, const World& world) {
    if (moves_in_space(world) || has_mobile(world)) {
        throw LoadError(scene.place_of("grab.molecule"),
                        "is not confined to a line; expected a molecule with motion along-x, and "
                        "no molecule that moves by itself");
    }
    const std::optional<double> rest = equilibrium_distance(world);
    if (!rest) {
        throw LoadError(scene.place_of("grab.molecule"),
                        "has no place on its line where attraction and repulsion balance; expected "
                        "molecules that attract each other");
    }
    return *rest;
}

double find_wall(const World& world, double outermost) {
    return repulsion_distance(world, through_nN / nN, outermost).value_or(0);
}

double find_rest(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    return find_rest(scene, load_world(scene));
}

std::string format_line(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    const World world = load_world(scene);
    const double rest = find_rest(scene, world);
    std::string text(line_names);
    for (int i = -100; i <= 700; ++i) {
        const double distance = rest + 0.01 * i;
        const double force = force_along_line_at(world, distance).force * nN;
        if (force < 3) text += fmt::format("{:.4f},{:.6f}\n", distance, force);
    }
    return text;
}

void check_study(const StudyOptions& options) {
    const SceneDescription scene = read_study_scene(options, {});
    if (!hand_model(scene.hands.front().grip)) {
        throw LoadError(scene.place_of("hand.grip"),
                        "is \"none\", so nobody moves the handle; expected a grip that holds it, "
                        "such as \"medium\"");
    }
    (void)find_rest(scene, load_world(scene));
}

EmulatedOmniSettings build_study_device(const SceneDescription& scene, const HandScript& script) {
    EmulatedOmniSettings settings = build_emulated_omni(scene, script);
    settings.half_workspace_m = Vec3::Constant(0.5);
    return settings;
}

}  // namespace palpa
