// The scene of the paper's experiment: its place without force, and the device of a trial.
#pragma once
#include "devices/emulated_omni.h"
#include "ecs/world.h"
#include "experiments/study.h"
#include "haptics/hand.h"
#include "scene/description.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct StudyOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file
    std::size_t rounds = 3;
    std::vector<CouplingMode> modes{CouplingMode::VariableForceVariableDisplacement,
                                    CouplingMode::VariableForceConstantDisplacement,
                                    CouplingMode::ConstantForceVariableDisplacement,
                                    CouplingMode::ConstantForceConstantDisplacement,
                                    CouplingMode::NoForce,
                                    CouplingMode::Guarded};
    std::uint64_t seed = 1;
};

// The period in the paper for its waters; the setting run.period_ms replaces it.
inline constexpr double study_period_ms = 14;

// Reads the scene with a study's period, then the options' settings, then `settings`. Throws
// LoadError, as do all below.
SceneDescription read_study_scene(const StudyOptions& options,
                                  const std::vector<std::string>& settings);
// The place without force, Å.
double find_rest(const SceneDescription& scene, const World& world);
double find_rest(const StudyOptions& options);
// A participant further in than this (Å) went through: forces there cannot be distinguished.
double find_wall(const World& world, double outermost);
// The force that was searched, from 3 nN of repulsion outward, for figures; and its columns.
inline constexpr std::string_view line_names = "distance_angstrom,force_nN\n";
std::string format_line(const StudyOptions& options);
// Checks that the scene has such a place, and a hand.
void check_study(const StudyOptions& options);
// The scene's, on a bench that is long enough: the way in is longer than an Omni's box, and nobody
// here knows how to clutch.
EmulatedOmniSettings build_study_device(const SceneDescription& scene, const HandScript& script);

}  // namespace palpa
