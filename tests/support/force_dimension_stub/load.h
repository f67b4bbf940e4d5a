// The test's hold on the stub library that CMake names.
#pragma once
#include "platform/library.h"
#include "tests/support/force_dimension_stub/stub.h"

#include <stdexcept>

namespace palpa::test {

// A new one, whole and quiet, takes the place of the one before; nothing may be open then.
inline ForceDimensionStub& load_force_dimension_stub() {
    const SharedLibrary library(PALPA_FORCE_DIMENSION_STUB);
    if (!library.is_open()) throw std::runtime_error(library.problem());
    void* const make = library.find("force_dimension_stub");
    return *reinterpret_cast<ForceDimensionStub* (*)()>(make)();
}

}  // namespace palpa::test
