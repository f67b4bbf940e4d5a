// The instruction sets for which the single-precision kernels are compiled. At run time the best
// one of this processor is used; only tests and benches choose another.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Instruction sets that this processor supports, best first, by Highway's names: "AVX3" (AVX-512),
// "AVX2", "SSE4", "SCALAR".
std::vector<std::string> list_processor_kinds();

// Makes all later kernel calls use this instruction set of the list. Not while another thread calls
// a kernel.
void use_processor_kind(std::string_view kind);

}  // namespace palpa
