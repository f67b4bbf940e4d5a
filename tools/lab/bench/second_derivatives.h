// Part of palpa-lab bench --statics: second derivatives and their factor.
#pragma once
#include "ecs/world.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

// Of a scene in which something moves by itself, at rest: rows second-derivatives/SCENE/double,
// /fast and /fast/9.5 (all pairs, and both forces switched from 7.5 to 9.5 Å), /product (with one
// direction, by fast forces), and factorise/SCENE and solve/SCENE; beside these the fast forces
// themselves, forces/SCENE/fast, which all may be measured against.
void bench_second_derivatives(const std::string& scene_name, const World& start,
                              std::vector<BenchRow>& rows);

}  // namespace palpa
