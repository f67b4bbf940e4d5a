// palpa-lab bench --servo: how long a tick of guarded coupling takes.
#pragma once
#include "scene/description.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

// Rows servo/GROUPxATOMS: a tick of made-up molecules, with a contact model every 14 ticks and the
// handle to and fro; p99 stands beside it. No tick is written to a device.
void bench_made_up_servo(std::vector<BenchRow>& rows);

// The same of the molecule in hand of a scene, where it starts.
void bench_servo(const std::string& scene_name, const SceneDescription& scene,
                 std::vector<BenchRow>& rows);

}  // namespace palpa
