// palpa-lab bench --engine: what a frame of a remote engine costs its client.
#pragma once
#include "tools/lab/bench/row.h"

#include <vector>

namespace palpa {

// Rows engine/frame/ATOMS: the time in which the client reads, checks and converts a frame that a
// server in the same thread sends over the loopback, and a table of atoms takes it;
// engine/pull/ATOMS: in which it sends forces on so many atoms.
void bench_engine(std::vector<BenchRow>& rows);

}  // namespace palpa
