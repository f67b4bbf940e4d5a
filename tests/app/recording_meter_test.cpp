#include "app/recording_meter.h"

#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

using namespace palpa;

TEST_CASE("a recording is as large as all its files, and grows at the rate since its begin",
          "[app][recording]") {
    const test::TemporaryFolder folder;
    (void)folder.add_file("journal.txt", std::string(5'000'000, 'j'));  // from before
    std::filesystem::create_directory(folder.path() / "inputs");
    (void)folder.add_file("inputs/a.crd", "0123456789");
    RecordingMeter meter;

    const std::optional<RecordingState> begin = meter.measure(folder.path(), 0);
    REQUIRE(begin);
    CHECK(begin->bytes == 5'000'010);
    CHECK(begin->free_bytes == std::filesystem::space(folder.path()).available);
    CHECK(begin->bytes_per_s == 0);
    CHECK_FALSE(seconds_left(*begin));
    CHECK_FALSE(meter.measure(folder.path(), 0.1));  // too early

    (void)folder.add_file("trace.csv", std::string(2'000'000, 't'));
    std::optional<RecordingState> later;
    while (!later) later = meter.measure(folder.path(), 4);
    CHECK(later->bytes == 7'000'010);
    CHECK(later->bytes_per_s == 500'000);
}

TEST_CASE("the free space on the disk lasts for its size divided by the rate", "[app][recording]") {
    RecordingState state{.recorded_s = 1, .bytes = 1, .free_bytes = 600'000'000};
    CHECK_FALSE(seconds_left(state));
    state.bytes_per_s = 1e6;
    CHECK(seconds_left(state) == 600);
    state.free_bytes.reset();
    CHECK_FALSE(seconds_left(state));
}

TEST_CASE("sizes are written in the unit that a person reads", "[app][recording]") {
    CHECK(describe_bytes(0) == "0 MB");
    CHECK(describe_bytes(12'400'000) == "12 MB");
    CHECK(describe_bytes(999'000'000) == "999 MB");
    CHECK(describe_bytes(4'810'000'000) == "4.8 GB");
    CHECK(describe_bytes(48'300'000'000) == "48 GB");
}
