// The kinds of processor that single-precision kernels are compiled for. At run time the best that
// this one has is chosen; only tests and benches choose themselves.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Those that this processor can run, best first, by Highway's names: "AVX3" (that is AVX-512),
// "AVX2", "SSE4", "SCALAR".
std::vector<std::string> list_processor_kinds();

// Makes all later calls of kernels use one of the kinds listed. Not while another thread calls one.
void use_processor_kind(std::string_view kind);

}  // namespace palpa
