// palpa-lab bench --tree: how long joint accelerations take, and how that grows.
#pragma once
#include "molecule/atoms.h"
#include "tools/lab/bench/row.h"

#include <string>
#include <vector>

namespace palpa {

// Rows tree/SCENE/joints=N: with the joints that turn by rule, and with those that have all rotors
// of hydrogens too; of all joints, and of the forty that are chosen. Bases are fixed. Forces are
// random; times do not depend on them.
void bench_tree(const std::string& scene_name, const AtomTable& atoms, std::vector<BenchRow>& rows);

// Rows tree/polymer/joints=N of chains of CH2 up to 20000, and the exponent of the growth.
void bench_polymers(std::vector<BenchRow>& rows);

}  // namespace palpa
