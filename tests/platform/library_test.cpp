#include "platform/library.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

using namespace palpa;

namespace {

#ifdef _WIN32
const std::string system_library = "msvcrt.dll";
#else
const std::string system_library = "libc.so.6";
#endif

}  // namespace

TEST_CASE("a library of the system is found, and its functions called", "[platform][library]") {
    const SharedLibrary library(system_library);
    REQUIRE(library.is_open());

    void* const found = library.find("labs");
    REQUIRE(found);
    CHECK(reinterpret_cast<long (*)(long)>(found)(-7) == 7);
    CHECK_FALSE(library.find("no_such_function_in_there"));
    CHECK(std::filesystem::exists(library.path_of(found)));
}

TEST_CASE("a library that is not there is named with the reason", "[platform][library]") {
    const SharedLibrary library("no-such-library");

    CHECK_FALSE(library.is_open());
    CHECK_THAT(library.problem(), Catch::StartsWith("no-such-library: "));
}

TEST_CASE("files of a library are called as the system does", "[platform][library]") {
    const std::vector<std::string> files = list_library_files("HD", {"3.4", "3"});
#ifdef _WIN32
    CHECK(files == std::vector<std::string>{"HD.dll"});
#else
    CHECK(files == std::vector<std::string>{"libHD.so", "libHD.so.3.4", "libHD.so.3"});
#endif
}
