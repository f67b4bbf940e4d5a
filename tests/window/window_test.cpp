#include "window/window.h"

#include <catch2/catch.hpp>
#include <cstdlib>

TEST_CASE("without a display a window says so in a sentence", "[window]") {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    for (int attempt = 0; attempt < 2; ++attempt) {  // a failure leaves nothing behind
        CHECK_THROWS_WITH(
            palpa::Window("test", 64, 64),
            Catch::Matchers::StartsWith("no display (") && Catch::Matchers::Contains("--headless"));
    }
}
