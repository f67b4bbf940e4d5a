// From a structure file to a scene: read, prepared, given something for the hand.
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
    bool only_these_files = false;                   // in place of it
    PrepareSettings settings{};
    bool makes_scene = true;  // false: a system alone
    std::string grab{};       // as of tune_scene
    std::string title{};      // what the files say of themselves; empty: a line of our own
};

struct MadeScene {
    PreparedSystem system;
    TunedScene scene;
    std::string title;  // for write_prepared
};

// A structure of which no scene can be made is prepared all the same, and the report says why.
// Throws LoadError as prepare_system does (UnknownResidues too), and where `grab` names nothing.
MadeScene make_scene(const SceneRequest& request, const StageFunction& on_stage);

}  // namespace palpa
