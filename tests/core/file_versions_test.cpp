// Rules of semantic versioning, by hand: a newer major number is refused, a newer minor one noted.
#include "core/file_versions.h"

#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <optional>
#include <string>

using namespace palpa;
using Catch::Matchers::Contains;

TEST_CASE("a version is two whole numbers, or one", "[core][versions]") {
    CHECK(find_version("2.0") == FileVersion{2, 0});
    CHECK(find_version("2") == FileVersion{2, 0});
    CHECK(find_version("10.12") == FileVersion{10, 12});
    CHECK(FileVersion{2, 9} < FileVersion{2, 10});
    CHECK(FileVersion{2, 10} < FileVersion{3, 0});
    for (const char* const text : {"", ".", "2.", ".0", "2.0.1", "-1", "2.-1", "+2", " 2", "2 ",
                                   "two", "2,0", "1e1", "99999", "1.99999999999999999999"}) {
        INFO(text);
        CHECK_FALSE(find_version(text));
    }
}

TEST_CASE("a version is written as it is read", "[core][versions]") {
    for (const FileVersion version : {scene_version, recording_version, journal_version})
        CHECK(find_version(to_string(version)) == version);
    CHECK_THAT(list_file_versions(), Contains("scene " + to_string(scene_version)) &&
                                         Contains("recording " + to_string(recording_version)) &&
                                         Contains("journal " + to_string(journal_version)));
}

TEST_CASE("an older minor version and the own one need no word, a newer one a note",
          "[core][versions]") {
    const FileVersion ours{2, 3};
    const TextPlace place{"a.toml", 4};
    for (const FileVersion stated : {FileVersion{2, 0}, ours})
        CHECK_FALSE(check_version("scene", stated, ours, place));
    const std::optional<std::string> note = check_version("scene", {2, 4}, ours, place);
    REQUIRE(note);
    CHECK_THAT(*note, Contains("scene format 2.4 is newer than 2.3"));
}

TEST_CASE("another major version is refused with what to do", "[core][versions]") {
    const auto error_of = [](FileVersion stated) {
        return test::load_error_of(
            [&] { (void)check_version("journal", stated, {2, 3}, {"journal.txt", 1}); });
    };
    CHECK_THAT(error_of({3, 0}), Contains("journal.txt:1: journal format 3.0 is newer") &&
                                     Contains("expected format 2.3, or a newer Palpa"));
    CHECK_THAT(error_of({1, 9}), Contains("journal format 1.9 is older"));
}
