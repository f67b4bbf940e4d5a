// palpa-lab bench --render: pictures of a surface of triangles.
#pragma once
#include "tools/lab/bench/row.h"

#include <vector>

namespace palpa {

// Whole frames of a closed surface of 60,000 triangles that fills the picture's height: opaque,
// open (its inside is drawn too), and translucent.
void bench_meshes(std::vector<BenchRow>& rows);

}  // namespace palpa
