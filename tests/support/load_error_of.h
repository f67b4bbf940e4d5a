// The message of the LoadError that a call throws, for tests of error messages.
#pragma once
#include "core/load_error.h"

#include <string>

namespace palpa::test {

// "no error" if the call returns; any other exception passes through and fails the test.
template <class Call>
std::string load_error_of(Call&& call) {
    try {
        call();
    } catch (const LoadError& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace palpa::test
