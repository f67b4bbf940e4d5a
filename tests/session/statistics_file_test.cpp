#include "session/statistics_file.h"

#include "core/files.h"
#include "core/load_error.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <vector>

using namespace palpa;

namespace {

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
    return parts;
}

}  // namespace

TEST_CASE("every second of ticks is a row, of that second alone", "[session][statistics]") {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "run.csv";
    StatisticsFile file(path);
    ServoTick tick;
    for (int i = 0; i < 2500; ++i) {
        const bool is_first_second = i < 1000;
        if (i % 500 == 0) file.add_step(is_first_second ? 1000 : 10);
        tick.sent_newton.x() = is_first_second ? 2 : 1;
        tick.hand_energy_J = 1e-3 * (i + 1);
        tick.contact.potential_kcal_per_mol = -6.5;
        tick.stage = i < 250 ? SafetyStage::Jump : SafetyStage::None;
        file.add(tick, i < 1500 ? 3 : 7);
    }

    const std::vector<std::string> rows = split(read_text_file(path), '\n');

    REQUIRE(rows.size() == 3);  // the third second is not over
    CHECK(rows[0] == statistics_header);
    const std::vector<std::string> first = split(rows[1], ','), second = split(rows[2], ',');
    REQUIRE(first.size() == split(std::string(statistics_header), ',').size());
    CHECK(first[1] == "1.000");
    CHECK(second[1] == "2.000");
    CHECK(first[2] == "2");                                    // steps
    CHECK(std::stod(first[3]) == Approx(1000).epsilon(0.01));  // median, us
    CHECK(std::stod(second[4]) == Approx(10).epsilon(0.01));   // p99
    CHECK(first[5] == "1000");                                 // most
    CHECK(second[5] == "10");
    CHECK(first[6] == "3");  // overruns
    CHECK(second[6] == "4");
    CHECK(first[7] == "0.25");  // held back
    CHECK(second[7] == "0");
    CHECK(first[8] == "2");  // largest force
    CHECK(second[8] == "1");
    CHECK(std::stod(second[9]) == Approx(2));  // energy so far
    CHECK(second[10] == "-6.5");
}

TEST_CASE("statistics replace only statistics, and only when asked to", "[session][statistics]") {
    const test::TemporaryFolder folder;
    const auto path = folder.path() / "run.csv";
    {
        const StatisticsFile first(path);
    }

    CHECK_THROWS_AS(StatisticsFile(path), LoadError);
    CHECK_NOTHROW(StatisticsFile(path, true));

    const auto other = folder.path() / "mine.csv";
    write_text_file(other, "a,b\n1,2\n");
    CHECK_THROWS_AS(StatisticsFile(other, true), LoadError);
    CHECK(read_text_file(other) == "a,b\n1,2\n");
}
