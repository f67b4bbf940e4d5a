// A trace is written here row by row, so what the check has to find is known.
#include "session/replay.h"

#include "core/load_error.h"
#include "session/recording.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Matchers::Contains;

namespace {

std::vector<ServoTick> some_ticks(int count) {
    std::vector<ServoTick> ticks(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        ServoTick& tick = ticks[static_cast<std::size_t>(i)];
        tick.reading.time_s = 1e-3 * i;
        tick.sent_newton = Vec3(0.1 * i, -0.2, 0.3);
    }
    return ticks;
}

std::string trace_of(const std::vector<ServoTick>& ticks, std::size_t every) {
    std::string text = trace_header() + "\n";
    for (std::size_t i = 0; i < ticks.size(); i += every) text += trace_row(ticks[i]);
    return text;
}

TraceCheck check_of(const std::string& trace, const std::vector<ServoTick>& played,
                    std::uint64_t ticks, std::int64_t every) {
    const test::TemporaryFolder folder;
    folder.add_file("trace.csv", trace);
    TraceCheck check(folder.path(), ticks, every);
    for (const ServoTick& tick : played) check.add(tick);
    return check;
}

}  // namespace

TEST_CASE("the same ticks have no difference, whatever share of the rows is kept",
          "[session][replay]") {
    const int every = GENERATE(1, 3, 4);
    const std::vector<ServoTick> ticks = some_ticks(10);

    const TraceCheck check =
        check_of(trace_of(ticks, static_cast<std::size_t>(every)), ticks, 10, every);

    const std::uint64_t rows = every == 1 ? 10 : every == 3 ? 4 : 3;
    CHECK(check.recorded() == rows);
    CHECK(check.compared() == rows);
    CHECK(check.different() == 0);
    CHECK_FALSE(check.first());
    CHECK_FALSE(check.is_cut_off());
    CHECK(check.surplus() == 0);
}

TEST_CASE("the first difference has its row, time, column and both values", "[session][replay]") {
    const std::vector<ServoTick> recorded = some_ticks(6);
    std::vector<ServoTick> played = recorded;
    played[2].sent_newton.x() = 0.25;   // recorded as 0.2
    played[4].sent_newton.y() = -0.45;  // -0.2
    played[4].sent_newton.z() = 0.31;   // 0.3

    const TraceCheck check = check_of(trace_of(recorded, 1), played, 6, 1);

    CHECK(check.compared() == 6);
    CHECK(check.different() == 2);
    REQUIRE(check.first());
    CHECK(check.first()->row == 3);
    CHECK(check.first()->time_s == "0.002");
    CHECK(check.first()->column == "device_force_x_N");
    CHECK(check.first()->recorded == "0.2");
    CHECK(check.first()->played == "0.25");
    CHECK(check.largest_newton() == Approx(0.25));
}

TEST_CASE("a row with a column more or less is reported", "[session][replay]") {
    const std::vector<ServoTick> ticks = some_ticks(2);
    const auto columns = std::ranges::count(trace_header(), ',') + 1;
    std::string trace = trace_of(ticks, 1);
    const bool is_longer = GENERATE(true, false);
    if (is_longer) {
        trace.insert(trace.size() - 1, ",1");
    } else {
        trace.erase(trace.rfind(','), trace.size() - 1 - trace.rfind(','));
    }

    const TraceCheck check = check_of(trace, ticks, 2, 1);

    CHECK(check.different() == 1);
    REQUIRE(check.first());
    CHECK(check.first()->row == 2);
    CHECK(check.first()->column == "number of columns");
    CHECK(check.first()->recorded == std::to_string(columns + (is_longer ? 1 : -1)));
    CHECK(check.first()->played == std::to_string(columns));
}

TEST_CASE("a trace that was cut off counts to its last whole line", "[session][replay]") {
    const std::vector<ServoTick> ticks = some_ticks(6);
    std::string trace = trace_of(ticks, 1);
    trace.resize(trace.size() - 5);

    const TraceCheck check = check_of(trace, ticks, 6, 1);

    CHECK(check.is_cut_off());
    CHECK(check.recorded() == 5);
    CHECK(check.compared() == 5);
    CHECK(check.different() == 0);
    CHECK(check.surplus() == 0);
}

TEST_CASE("rows that no tick has are surplus", "[session][replay]") {
    const std::vector<ServoTick> ticks = some_ticks(6);

    const TraceCheck check = check_of(trace_of(ticks, 1), ticks, 4, 1);

    CHECK_FALSE(check.is_cut_off());
    CHECK(check.surplus() == 2);
}

TEST_CASE("a trace without a line or with other columns is refused", "[session][replay]") {
    CHECK_THROWS_WITH(check_of("time_s", {}, 1, 1), Contains("trace.csv:1: has no complete line"));
    CHECK_THROWS_WITH(check_of("time_s\n", {}, 1, 1),
                      Contains("trace.csv:1: lacks the column 'handle_x_m'"));
    CHECK_THROWS_WITH(check_of(trace_header() + ",other\n", {}, 1, 1),
                      Contains("trace.csv:1: has a column 'other', which no recording of format"));
}

namespace {

// Without the columns whose names contain the words.
std::string without_columns(const std::string& trace, const std::vector<std::string>& words) {
    std::istringstream lines(trace);
    std::string result;
    std::vector<bool> keeps;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream values(line);
        const bool is_header = keeps.empty();
        std::string kept;
        std::size_t column = 0;
        for (std::string value; std::getline(values, value, ','); ++column) {
            if (is_header)
                keeps.push_back(std::ranges::none_of(words, [&](const std::string& word) {
                    return value.find(word) != value.npos;
                }));
            if (keeps.at(column)) kept += (kept.empty() ? "" : ",") + value;
        }
        result += kept + "\n";
    }
    return result;
}

}  // namespace

TEST_CASE("columns that an older recording lacks are not compared, all others are",
          "[session][replay][format]") {
    const std::vector<ServoTick> recorded = some_ticks(6);
    std::vector<ServoTick> played = recorded;
    played[2].waiting_m.x() = 1;  // which the recording lacks
    played[4].sent_newton.y() = -0.45;
    const std::string trace = without_columns(trace_of(recorded, 1), {"waiting_m", "at_stop"});
    REQUIRE(trace.find("waiting") == std::string::npos);

    const TraceCheck check = check_of(trace, played, 6, 1);

    CHECK(check.compared() == 6);
    CHECK(check.different() == 1);
    REQUIRE(check.first());
    CHECK(check.first()->row == 5);
    CHECK(check.first()->column == "device_force_y_N");
    CHECK(check.first()->recorded == "-0.2");
    REQUIRE(check.notes().size() == 1);
    CHECK_THAT(check.notes()[0], Contains("lacks them: waiting_m") && Contains("at_stop"));
}

TEST_CASE("a row of an older recording with a column more is reported",
          "[session][replay][format]") {
    const std::vector<ServoTick> ticks = some_ticks(2);
    std::string trace = without_columns(trace_of(ticks, 1), {"waiting_m"});
    trace.insert(trace.size() - 1, ",1");

    const TraceCheck check = check_of(trace, ticks, 2, 1);

    CHECK(check.different() == 1);
    REQUIRE(check.first());
    CHECK(check.first()->column == "number of columns");
}

TEST_CASE("of a newer minor version unknown columns are left out, and a newer major one is refused",
          "[session][replay][format]") {
    const std::vector<ServoTick> ticks = some_ticks(3);
    std::string trace = trace_header() + ",heat_K\n";
    for (const ServoTick& tick : ticks) {
        std::string row = trace_row(tick);
        trace += row.insert(row.size() - 1, ",300");
    }
    const test::TemporaryFolder folder;
    folder.add_file("trace.csv", trace);
    const auto state = [&](const std::string& version) {
        folder.add_file("session.toml",
                        "# A recorded Palpa session\n# Recording format " + version + "\n");
    };

    state("2.99");
    TraceCheck check(folder.path(), 3, 1);
    for (const ServoTick& tick : ticks) check.add(tick);

    CHECK(read_recording_version(folder.path()) == FileVersion{2, 99});
    CHECK(check.compared() == 3);
    CHECK(check.different() == 0);
    REQUIRE(check.notes().size() == 1);
    CHECK_THAT(check.notes()[0], Contains("does not know them: heat_K"));
    state("3.0");
    CHECK_THROWS_WITH(
        read_recorded_scene(folder.path()),
        Contains("recording format 3.0 is newer than this program") && Contains("a newer Palpa"));
}

TEST_CASE("a trace of two hands is held against the ticks of both", "[session][replay]") {
    const std::vector<ServoTick> ticks = some_ticks(2);
    std::vector<ServoTick> changed = ticks;
    changed[1].sent_newton.x() += 0.5;
    const test::TemporaryFolder folder;
    folder.add_file("trace.csv", trace_header(2) + "\n" + trace_row(ticks));

    TraceCheck same(folder.path(), 1, 1, 2), other(folder.path(), 1, 1, 2);
    same.add(ticks);
    other.add(changed);

    CHECK(same.different() == 0);
    REQUIRE(other.first());
    CHECK(other.first()->column == "device_force_x_N_2");
    CHECK(other.largest_newton() == Approx(0.5));
    CHECK_THROWS_AS(TraceCheck(folder.path(), 1, 1), LoadError);
}
