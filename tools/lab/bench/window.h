// palpa-lab bench --window: how long a person waits before something is felt.
#pragma once
#include "tools/lab/bench/row.h"

#include <filesystem>
#include <vector>

namespace palpa {

// Opens a window for each scene, or structure, which is prepared first, with the emulated hand in
// it, until the first force is sent to the device: seconds from opening the window to that, and
// parts of it; ms of the longest time that the window's thread was away from drawing while a
// structure was prepared. Throws PlatformError without a display, GpuError, LoadError.
void bench_window(const std::vector<std::filesystem::path>& files, std::vector<BenchRow>& rows);

}  // namespace palpa
