// The common part of studies by people (palpa study) and by emulated operators (palpa-lab study).
#pragma once
#include "core/files.h"
#include "experiments/study_scene.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace palpa {

// The scene, the modes, the seed, and settings that have an option of their own.
void add_study_options(CLI::App& command, StudyOptions& options);
// The number of rounds.
CLI::Option* add_rounds_option(CLI::App& command, StudyOptions& options);

// Makes the first keys of every summary.
nlohmann::ordered_json describe_study(const StudyOptions& options);
// Before anything is played: makes the folder and locks it. What people or operators did before is
// never written over: throws LoadError where one of `files` is there.
std::unique_ptr<FolderLock> make_study_folder(const std::filesystem::path& folder,
                                              std::initializer_list<const char*> files);

}  // namespace palpa
