// The test's hold on the stub library that CMake names.
#pragma once
#include "tests/support/open_haptics_stub/stub.h"

#include <dlfcn.h>
#include <stdexcept>

namespace palpa::test {

// A new one, whole and quiet, takes the place of the one before; nothing may be open then.
inline OpenHapticsStub& load_open_haptics_stub() {
    void* const library = dlopen(PALPA_OPEN_HAPTICS_STUB, RTLD_NOW | RTLD_LOCAL);
    if (!library) throw std::runtime_error(dlerror());
    void* const make = dlsym(library, "open_haptics_stub");
    return *reinterpret_cast<OpenHapticsStub* (*)()>(make)();
}

}  // namespace palpa::test
