// What palpa run says of a scene and of a run.
#pragma once
#include "scene/description.h"
#include "session/statistics.h"
#include "simulation/simulation.h"

namespace palpa {

// What the molecule will meet on its line, found by looking along it; what moves by itself.
void print_line(const SceneDescription& scene, const Simulation& simulation);

void print_summary(const SceneDescription& scene, const Summary& summary);

}  // namespace palpa
