// Measures period and gains of the open scene while a person plays, where its file was measured on
// another machine or not at all (run.measured_on).
#pragma once
#include "ecs/world.h"

#include <cstdint>
#include <string>
#include <vector>

namespace palpa {

struct SceneMeasure {
    bool measures_period = false, measures_gains = false;
    std::vector<double> step_ms{};   // of steps with something in hand
    std::vector<double> force_pN{};  // on what is in hand, where there was one
    std::uint64_t steps = 0;         // at the last look
};

// Decides what to measure on this machine (core/machine.h).
SceneMeasure begin_measure(const std::string& measured_on, const std::string& machine);

// Call once a frame. Changes the settings once enough was seen, and says so; the change need not be
// saved.
void measure_scene(World& app);

}  // namespace palpa
