// What a call makes, for fuzzers of readers and writers that may refuse.
#pragma once
#include "core/load_error.h"

#include <optional>

namespace palpa::test {

// Nothing where it throws a LoadError; any other exception passes through, and ends the fuzzer.
template <class Call>
auto or_refused(const Call& call) -> std::optional<decltype(call())> {
    try {
        return call();
    } catch (const LoadError&) {
        return std::nullopt;
    }
}

}  // namespace palpa::test
