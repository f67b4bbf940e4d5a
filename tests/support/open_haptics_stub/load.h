// The test's hold on the stub library that CMake names.
#pragma once
#include "platform/library.h"
#include "tests/support/open_haptics_stub/stub.h"

#include <stdexcept>

namespace palpa::test {

// A new one, whole and quiet, takes the place of the one before; nothing may be open then.
inline OpenHapticsStub& load_open_haptics_stub() {
    const SharedLibrary library(PALPA_OPEN_HAPTICS_STUB);
    if (!library.is_open()) throw std::runtime_error(library.problem());
    void* const make = library.find("open_haptics_stub");
    return *reinterpret_cast<OpenHapticsStub* (*)()>(make)();
}

}  // namespace palpa::test
