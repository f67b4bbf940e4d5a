// palpa-lab bench --mouse: how long a person at the mouse takes to draw a molecule out of its
// pocket.
#pragma once
#include "scene/description.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

// Adds a row, `mouse/NAME`: s on the machine's clock until what is held is free (UnbindingPath), of
// `runs` live sessions without a window, each with another MousePerson, who leads it 50 Å along the
// scene's path, or away from all others. A session that takes longer than `longest_s` counts as
// that. way (Å), speed (Å/s), handle_m, lost_share, strokes and largest_N are the medians.
void bench_mouse(const std::string& name, const SceneDescription& scene, int runs, double longest_s,
                 std::vector<BenchRow>& rows);

}  // namespace palpa
