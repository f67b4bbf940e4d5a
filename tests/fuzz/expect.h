// What a fuzzer calls where its property does not hold.
#pragma once
#include <cstdio>
#include <cstdlib>

// Stands in every build, unlike PALPA_ASSERT: the fuzzer takes the abort for its find.
#define PALPA_EXPECT(condition)                                                            \
    do {                                                                                   \
        if (!(condition)) {                                                                \
            std::fprintf(stderr, "%s:%d: expected: %s\n", __FILE__, __LINE__, #condition); \
            std::abort();                                                                  \
        }                                                                                  \
    } while (false)
