// palpa-lab bench --statics: what the adaptive step costs with everything active.
#pragma once
#include "ecs/world.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

// Rows statics/SCENE/stepper=NAME/PAIRS: as many steps as the scene makes in one period, and what
// the hand's move before them costs. Both steppers go the same way in turns; with all pairs and
// with a cutoff of 12 Å.
void bench_steppers(const std::string& scene_name, const World& world, std::vector<BenchRow>& rows);

}  // namespace palpa
