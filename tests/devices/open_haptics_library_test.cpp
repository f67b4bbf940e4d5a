#include "devices/open_haptics_library.h"

#include "platform/program.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

using namespace palpa;

TEST_CASE("all functions of the library are found by its file", "[devices][open-haptics]") {
    const hd::LibrarySearch search = hd::find_library(PALPA_OPEN_HAPTICS_STUB);

    REQUIRE(search.is_found);
    CHECK(search.missing.empty());
    CHECK(search.tried.empty());
    CHECK(std::filesystem::equivalent(search.path, PALPA_OPEN_HAPTICS_STUB));
    CHECK(search.library.get_error().code == hd::success);
}

TEST_CASE("a function that the library lacks is named", "[devices][open-haptics]") {
    const hd::LibrarySearch search = hd::find_library(PALPA_OPEN_HAPTICS_STUB_LACKING);

    REQUIRE(search.is_found);
    CHECK(search.missing == std::vector<std::string>{"hdUnschedule"});
}

// On Windows the system looks beside the program first, and the stub is called as the maker's
// library there.
TEST_CASE("the library is looked for by the names that its maker gives it",
          "[devices][open-haptics]") {
    const hd::LibrarySearch search = hd::find_library(std::nullopt);
#ifdef _WIN32
    REQUIRE(search.is_found);
    CHECK(std::filesystem::path(search.path).filename() == "HD.dll");
    CHECK(std::filesystem::equivalent(std::filesystem::path(search.path).parent_path(),
                                      find_program_file().parent_path()));
    CHECK(search.library.get_error().code == hd::success);
#else
    if (search.is_found) {  // on a machine that has it
        CHECK_FALSE(search.path.empty());
    } else {
        CHECK(search.tried.size() >= 4);
        CHECK_THAT(search.tried.front(), Catch::StartsWith("libHD.so: "));
    }
#endif
}
