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
    std::filesystem::path structure;                 // as read_structure takes it
    std::filesystem::path topology{};                // .psf: taken as it is (adopt_system)
    std::vector<std::filesystem::path> force_field;  // files, read after the built-in one
    bool only_these_files = false;                   // without the built-in force field
    PrepareSettings settings{};
    bool makes_scene = true;  // false: only the prepared system
    bool measures = true;     // gains and period, by playing; false: the window does it
    std::string grab{};       // as for tune_scene
    std::string title{};      // title in the files; empty: a default one
};

struct MadeScene {
    PreparedSystem system;
    TunedScene scene;
    std::string title;  // title for write_prepared
};

// Prepares the system, without a scene. Throws LoadError as prepare_system does (also
// UnknownResidues).
MadeScene prepare_request(const SceneRequest& request, const StageFunction& on_stage);

// Adds the scene if it is wanted. If none can be made the report gives the reason. Throws LoadError
// if `grab` names nothing.
void add_scene(const SceneRequest& request, const StageFunction& on_stage, MadeScene& made);

// Both, one after the other.
MadeScene make_scene(const SceneRequest& request, const StageFunction& on_stage);

}  // namespace palpa
