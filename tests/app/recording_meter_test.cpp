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

TEST_CASE("the rate of a recording is that of the last 10 to 20 s", "[app][recording]") {
    const test::TemporaryFolder folder;
    const auto size = [&](std::size_t bytes) {
        (void)folder.add_file("trace.csv", std::string(bytes, 't'));
    };
    size(0);
    RecordingMeter meter;
    const auto measure_at = [&](double recorded_s) {
        std::optional<RecordingState> state;
        while (!state) state = meter.measure(folder.path(), recorded_s);
        return state->bytes_per_s;
    };
    CHECK(measure_at(0) == 0);
    size(1'000'000);
    CHECK(measure_at(10.5) == Approx(1e6 / 10.5));
    size(1'300'000);  // slower from here on
    CHECK(measure_at(13.5) == Approx(1.3e6 / 13.5));
    size(2'100'000);
    CHECK(measure_at(21.5) == Approx(2.1e6 / 21.5));
    size(2'200'000);
    CHECK(measure_at(22.5) == Approx(1.2e6 / 12));
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
