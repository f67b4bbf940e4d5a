// palpa study: the paper's experiment, done by emulated operators or by people.
#pragma once
#include "core/files.h"
#include "devices/emulated_omni.h"
#include "devices/seeking_operator.h"
#include "haptics/hand.h"
#include "scene/description.h"
#include "session/study.h"
#include "simulation/simulation.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct StudyOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;  // "key=value", over the scene file
    std::size_t operators = 5;          // 0: a person, in a window
    std::size_t rounds = 3;
    OperatorManner manner = OperatorManner::Naive;
    std::vector<CouplingMode> modes{CouplingMode::VariableForceVariableDisplacement,
                                    CouplingMode::VariableForceConstantDisplacement,
                                    CouplingMode::ConstantForceVariableDisplacement,
                                    CouplingMode::ConstantForceConstantDisplacement,
                                    CouplingMode::NoForce,
                                    CouplingMode::Guarded};
    std::uint64_t seed = 1;
    double limit_s = 90;  // of a trial
    std::optional<std::filesystem::path> folder;
    bool json = false;
    bool validation = false;  // of a person's window
};

// What the paper declares for its waters; a setting of run.period_ms says otherwise.
inline constexpr double study_period_ms = 14;

// "1,2,guarded" as modes, each once. Throws LoadError.
std::vector<CouplingMode> modes_called(const std::string& names);
OperatorManner manner_called(const std::string& name);

// One trial of an emulated operator; the same whatever else is played. Throws LoadError.
StudyResult play_trial(const StudyOptions& options, const StudyTrial& trial);

// All of them, participant by participant in the order of their plans; `on_result` after each.
std::vector<StudyResult> play_study(
    const StudyOptions& options,
    const std::function<void(std::size_t done, std::size_t of)>& on_result = {});

// What forced choices have in common with it. All throw LoadError.

// With a study's period, then what the person at the command line says, then `settings`.
SceneDescription read_study_scene(const StudyOptions& options,
                                  const std::vector<std::string>& settings);
// The place that is to be found, Å.
double find_rest(const SceneDescription& scene, const Simulation& simulation);
double find_rest(const StudyOptions& options);
// Who is further in than this (Å) went through: no hand tells the forces there from each other.
double find_wall(const Simulation& simulation, double outermost);
// The force that was searched, from 3 nN of repulsion outward, for figures; and its columns.
inline constexpr std::string_view line_names = "distance_angstrom,force_nN\n";
std::string format_line(const StudyOptions& options);
// Whether there is such a place, and a hand.
void check_study(const StudyOptions& options);
// The scene's, on a bench that is long enough: the way in is longer than an Omni's box, and nobody
// here knows how to clutch.
EmulatedOmniSettings build_study_device(const SceneDescription& scene, const HandScript& script);
// How every summary begins.
nlohmann::ordered_json describe_study(const StudyOptions& options);
// Before anything is played: makes the folder and locks it. What people or operators did before is
// never written over: throws LoadError where one of `files` is there.
std::unique_ptr<FolderLock> make_study_folder(const std::filesystem::path& folder,
                                              std::initializer_list<const char*> files);

// Throws LoadError on bad input. Returns the exit code.
int study_command(const StudyOptions& options);

}  // namespace palpa
