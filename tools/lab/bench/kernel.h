// palpa-lab bench --kernel: the kernels of pairs, for each kind of processor that this one can be.
#pragma once
#include "scene/description.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

// Of all atoms of the scene's first topology. Throws LoadError where no molecule has one.
void bench_kernels(const std::string& scene_name, const SceneDescription& scene,
                   std::vector<BenchRow>& rows);

// All terms alone, with energies: of all pairs, and switched off at 12 Å.
void bench_force_field(const std::string& scene_name, const SceneDescription& scene,
                       std::vector<BenchRow>& rows);

// Of a made-up gas of as many atoms as a small protein has.
void bench_gas_kernels(std::vector<BenchRow>& rows);

}  // namespace palpa
