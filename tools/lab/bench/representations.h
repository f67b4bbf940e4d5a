// palpa-lab bench --render: pictures of a scene, in each representation.
#pragma once
#include "ecs/world.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

// For each representation: the time to build a frame alone, and one after another while atoms move;
// and whole frames, recorded, submitted and waited for, of two sizes, in the last row of each with
// the colours brought back. All with marks: hydrogen bonds and the force on what is in hand.
void bench_representations(const std::string& scene_name, World world, std::vector<BenchRow>& rows);

// Of a large world: balls and sticks, spheres, lines and a cartoon at 1280x720, `large/` before the
// names: the time to build a frame where nothing has moved, to draw it, and both.
void bench_large_pictures(const std::string& scene_name, World world, std::vector<BenchRow>& rows);

}  // namespace palpa
