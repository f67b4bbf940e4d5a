#include "devices/force_dimension_library.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

using namespace palpa;

TEST_CASE("all functions of Force Dimension's library are found by its file",
          "[devices][force-dimension]") {
    const dhd::LibrarySearch search = dhd::find_library(PALPA_FORCE_DIMENSION_STUB);

    REQUIRE(search.is_found);
    CHECK(search.missing.empty());
    CHECK(search.tried.empty());
    CHECK(std::filesystem::equivalent(search.path, PALPA_FORCE_DIMENSION_STUB));
    CHECK(std::string(search.library.get_system_name(0)) == "emulated omega");
}

TEST_CASE("a function that Force Dimension's library lacks is named",
          "[devices][force-dimension]") {
    const dhd::LibrarySearch search = dhd::find_library(PALPA_FORCE_DIMENSION_STUB_LACKING);

    REQUIRE(search.is_found);
    CHECK(search.missing == std::vector<std::string>{"dhdSetForce"});
}

TEST_CASE("Force Dimension's library is looked for by the names that its maker gives it",
          "[devices][force-dimension]") {
    const dhd::LibrarySearch search = dhd::find_library(std::nullopt);
#ifdef _WIN32
    REQUIRE(search.is_found);
    CHECK(std::filesystem::path(search.path).filename() == "dhd64.dll");
#else
    if (search.is_found) {  // on a machine that has it
        CHECK_FALSE(search.path.empty());
    } else {
        const auto is_tried = [&](const char* name) {
            for (const std::string& tried : search.tried)
                if (tried.starts_with(name)) return true;
            return false;
        };
        CHECK(is_tried("libdhd.so: "));
        CHECK(is_tried("libdhd.so.3: "));
    }
#endif
}
