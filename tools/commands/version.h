// What `palpa --version` prints: what a report of a problem needs.
#pragma once
#include <string>

namespace palpa {

// Version and commit on the first line, which scripts read; then a line each for the compiler, the
// kind of processor whose kernels run here, and the Vulkan device, or why there is none.
std::string describe_version();

}  // namespace palpa
