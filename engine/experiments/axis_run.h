// A scene of one axis played: what every tick felt, against what the law says at rest.
#pragma once
#include "ecs/world.h"
#include "haptics/hand.h"
#include "haptics/safety.h"
#include "scene/description.h"
#include "session/reading.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// A run in lockstep under the emulated hand.
struct AxisRun {
    std::vector<Reading> readings;          // of every tick
    double ripple_N = 0, ripple_hertz = 0;  // of the last 4 s
    double closest_angstrom = 0, last_angstrom = 0;
    double largest_nN = 0;    // on the molecule, by the law where it is
    double energy_J = 0;      // given to the hand
    double error_N = 0;       // rms, force sent but for the servo's damping less the law at rest
    double attraction_N = 0;  // felt, but for that damping
    int at_clamp = 0;         // ticks
    SafetyStage stage = SafetyStage::None;  // the gravest
};

struct AxisCase {
    std::filesystem::path scene;
    std::vector<std::string> settings;   // "key=value", over the scene file
    std::optional<HandModel> hand = {};  // instead of the scene's
    bool cools = false;                  // motors stay cold, however long they push
};

// Throws LoadError.
AxisRun play_axis(const AxisCase& c);

}  // namespace palpa
