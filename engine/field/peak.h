// Measures the peak speed of the processor.
#pragma once
#include <cstddef>

namespace palpa {

struct PeakRun {
    double operations = 0;  // floating-point; a product and a sum are two
    float result = 0;       // only keeps the compiler from removing the work
};

// Multiplies and adds in single precision and nothing else, out of registers, as wide as the kind
// of processor in use (field/processor.h): the time of a call is the least that so many operations
// can take on one core.
PeakRun run_multiply_adds(std::size_t rounds) noexcept;

}  // namespace palpa
