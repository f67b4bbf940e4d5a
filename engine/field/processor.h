// The instruction sets for which the single-precision kernels are compiled. At run time the best
// one of this processor is used, unless tests, benches, a replay or the environment choose another.
// Two kinds sum in different orders, and all but "SCALAR" begin with a processor's estimates of
// 1/x.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Instruction sets that this processor supports, best first, by Highway's names: "AVX3" (AVX-512),
// "AVX2", "SSE4", "SCALAR".
std::vector<std::string> list_processor_kinds();

// The instruction set in use.
std::string processor_kind();

// Makes all later kernel calls use this instruction set of the list. Not while another thread calls
// a kernel.
void use_processor_kind(std::string_view kind);

}  // namespace palpa
