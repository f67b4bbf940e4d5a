// What palpa run says of a scene and of a run.
#pragma once
#include "scene/description.h"
#include "session/statistics.h"
#include "simulation/simulation.h"
#include "tools/progress.h"

namespace palpa {

// What the molecule will meet on its line, found by looking along it; what moves by itself.
// Shows on `progress` where it looks, which takes minutes in a large rigid scene.
void print_line(const SceneDescription& scene, const Simulation& simulation,
                ProgressLine& progress);

void print_summary(const SceneDescription& scene, const Summary& summary);

}  // namespace palpa
