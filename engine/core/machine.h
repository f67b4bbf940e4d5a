// The machine that the program runs on.
#pragma once
#include <string>

namespace palpa {

// Its processor, as it calls itself, and how many threads that runs.
std::string machine_name();

}  // namespace palpa
