// Makes a scene from a structure file: reads and prepares it, and chooses what the hand holds.
#pragma once
#include "core/stage.h"
#include "experiments/tune_scene.h"
#include "prepare/prepare.h"
#include "prepare/settings.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

struct SceneRequest {
    std::filesystem::path structure;                 // a file for read_structure
    std::vector<std::filesystem::path> force_field;  // files, read after the built-in one
    bool only_these_files = false;                   // without the built-in force field
    PrepareSettings settings{};
    bool makes_scene = true;  // false: only the prepared system
    std::string grab{};       // as for tune_scene
    std::string title{};      // title in the files; empty: a default one
};

struct MadeScene {
    PreparedSystem system;
    TunedScene scene;
    std::string title;  // title for write_prepared
};

// If no scene can be made, the structure is prepared all the same and the report gives the reason.
// Throws LoadError as prepare_system does (also UnknownResidues), and if `grab` names nothing.
MadeScene make_scene(const SceneRequest& request, const StageFunction& on_stage);

}  // namespace palpa
