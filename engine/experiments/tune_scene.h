// Makes the scene of a prepared system: plays it to find suitable gains and a period.
#pragma once
#include "core/files.h"
#include "core/stage.h"
#include "prepare/prepare.h"

#include <string>
#include <vector>

namespace palpa {

struct TunedScene {
    std::vector<TextFile> files;  // files of the scene, names without folder; empty: no scene
    std::string in_hand;          // "residue PRO 36 of A, on a spring"
    // From the emulated hand's stroke with the gains and the period of the file.
    double felt_newton = 0;     // largest force in any direction
    double moved_angstrom = 0;  // largest move of the centre of what the hand holds
};

// Chooses what the hand holds (prepare/hand_choice.h, `grab`; a residue where a chain that was not
// asked for hardly moves), brings a copy of the system to rest,
// turns it so that the way out is +x unless it `is_aligned`, plays the stroke with constant gains
// to find the forces and how long a step takes, and again with those in the file. What was found is
// added to the system's report, or why there is no scene. `title`: as for write_prepared; `name`:
// the scene's. Throws LoadError where there is nothing that `grab` names.
TunedScene tune_scene(PreparedSystem& system, const std::string& grab, bool is_aligned,
                      const std::string& name, const std::string& title,
                      const StageFunction& on_stage);

}  // namespace palpa
