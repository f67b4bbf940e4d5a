// What palpa study writes, by operators and by people.
#pragma once
#include "core/files.h"
#include "experiments/study_operators.h"

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <nlohmann/json_fwd.hpp>

namespace palpa {

// How every summary begins.
nlohmann::ordered_json describe_study(const StudyOptions& options);
// Before anything is played: makes the folder and locks it. What people or operators did before is
// never written over: throws LoadError where one of `files` is there.
std::unique_ptr<FolderLock> make_study_folder(const std::filesystem::path& folder,
                                              std::initializer_list<const char*> files);

}  // namespace palpa
