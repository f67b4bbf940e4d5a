// A validated device for tests; each test ends by asking it for what validation found.
#pragma once
#include "gpu/device.h"

#include <catch2/catch.hpp>
#include <string>

namespace palpa::test {

inline GpuOptions validated(bool force_staging = false) {
    return {.validation = true, .force_staging = force_staging};
}

inline void check_silent(const GpuDevice& device) {
    for (const std::string& message : device.validation_messages()) FAIL_CHECK(message);
}

}  // namespace palpa::test
