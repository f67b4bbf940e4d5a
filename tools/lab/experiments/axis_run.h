// Plays a scene of one axis and compares the force of every tick with the ideal law at rest.
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
    std::vector<Reading> readings;          // one for each tick
    double ripple_N = 0, ripple_hertz = 0;  // over the last 4 s
    double closest_angstrom = 0, last_angstrom = 0;
    double largest_nN = 0;  // largest force on the molecule at its place
    double energy_J = 0;    // energy given to the hand
    double error_N = 0;  // rms of the sent force without servo damping, minus the ideal law at rest
    double attraction_N = 0;                // largest attraction felt, without servo damping
    int at_clamp = 0;                       // number of ticks at the force limit
    SafetyStage stage = SafetyStage::None;  // most severe safety stage
};

struct AxisCase {
    std::filesystem::path scene;
    std::vector<std::string> settings;   // "key=value", over the scene file
    std::optional<HandModel> hand = {};  // in place of the scene's hand
    bool cools = false;                  // motors do not heat up
};

// Throws LoadError.
AxisRun play_axis(const AxisCase& c);

}  // namespace palpa
