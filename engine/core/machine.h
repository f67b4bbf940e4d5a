// Describes the machine.
#pragma once
#include <string>

namespace palpa {

// Name of the processor and its number of threads.
std::string machine_name();

}  // namespace palpa
