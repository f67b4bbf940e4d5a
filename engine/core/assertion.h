// PALPA_ASSERT checks for programming errors, never for bad input. On in debug builds and under the
// sanitizers.
#pragma once
#ifdef PALPA_ASSERTIONS
#include <cstdio>
#include <cstdlib>
#define PALPA_ASSERT(condition)                                                                    \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            std::fprintf(stderr, "%s:%d: assertion failed: %s\n", __FILE__, __LINE__, #condition); \
            std::abort();                                                                          \
        }                                                                                          \
    } while (false)
#else
#define PALPA_ASSERT(condition) static_cast<void>(0)
#endif
