// palpa-lab bench --statics: ways to rest, and what a region saves.
#pragma once
#include "scene/description.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

// Rows statics/SCENE/METHOD/rms=F: time, and steps and evaluations, until the rms force along the
// coordinates is below F kcal/mol per radian and Å, from the scene's structure with the molecule in
// hand shifted by 0.3 Å. And statics/SCENE/step/within=R: one step of the simulation with joints
// only within R Å of the molecule in hand. Of scenes in which something moves by itself.
void bench_statics(const std::string& scene_name, const SceneDescription& scene,
                   std::vector<BenchRow>& rows);

}  // namespace palpa
