#include "devices/played_handle.h"

#include "tests/support/load_error_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Matchers::WithinAbs;

namespace {

const std::string header = "time_s,handle_x_m,handle_y_m,handle_z_m\n";

PlayedHandle play(const std::string& script, HandOrders* orders = nullptr) {
    return PlayedHandle({.rows = parse_script(script, "hand.csv"), .orders = orders});
}

// The reading so many ticks later.
DeviceReading after(PlayedHandle& handle, int ticks) {
    for (int i = 0; i < ticks; ++i) handle.write(Vec3(1, 2, 3));
    return handle.read();
}

std::string told(const std::string& script) {
    return test::load_error_of([&] { (void)parse_script(script, "hand.csv"); });
}

}  // namespace

TEST_CASE("a scripted handle goes evenly from row to row, whatever pushes it",
          "[devices][played]") {
    PlayedHandle handle =
        play("# there and back\n" + header + "0.1,0.01,0,0\n\n0.3, 0.03,0.04,-0.02 \n0.31,0,0,0");

    CHECK(handle.read().position_m == Vec3(0.01, 0, 0));
    CHECK(after(handle, 100).position_m == Vec3(0.01, 0, 0));
    CHECK((after(handle, 50).position_m - Vec3(0.015, 0.01, -0.005)).norm() < 1e-12);
    CHECK(after(handle, 150).position_m == Vec3(0.03, 0.04, -0.02));
    CHECK((after(handle, 5).position_m - Vec3(0.015, 0.02, -0.01)).norm() < 1e-12);
    CHECK(after(handle, 500).position_m == Vec3::Zero());
    CHECK_THAT(handle.read().time_s, WithinAbs(0.805, 1e-12));
    CHECK(handle.read().valid);
}

TEST_CASE("columns stand in any order, the clutch stays pressed until the next row",
          "[devices][played]") {
    PlayedHandle handle = play(
        "clutch,handle_turn_z_rad,handle_z_m,handle_y_m,handle_x_m,time_s\n"
        "0,0,3e-3,2e-3,1e-3,0\n1,0,3e-3,2e-3,1e-3,0.01\n0,1.5,3e-3,2e-3,1e-3,0.02\n");

    CHECK(handle.read().position_m == Vec3(1e-3, 2e-3, 3e-3));
    CHECK_FALSE(is_pressed(after(handle, 9).buttons, Button::Clutch));
    CHECK(is_pressed(after(handle, 1).buttons, Button::Clutch));
    CHECK(is_pressed(after(handle, 9).buttons, Button::Clutch));
    CHECK_FALSE(is_pressed(after(handle, 1).buttons, Button::Clutch));
    // Turned about z by 1.5 rad: cos of half the angle.
    CHECK_THAT(handle.read().orientation.w(), WithinAbs(std::cos(0.75), 1e-12));
    CHECK_THAT(handle.read().orientation.z(), WithinAbs(std::sin(0.75), 1e-12));
}

TEST_CASE("a script may begin with a byte order mark", "[devices][played]") {
    const std::vector<PlayedRow> rows =
        parse_script("\xef\xbb\xbf" + header + "0,0.01,0,0\n", "hand.csv");

    REQUIRE(rows.size() == 1);
    CHECK(rows[0].handle_m == Vec3(0.01, 0, 0));
}

TEST_CASE("a trace's other columns are passed over, and a line that was cut off",
          "[devices][played]") {
    const test::TemporaryFolder folder;
    (void)folder.add_file("trace.csv",
                          "time_s,handle_x_m,handle_y_m,handle_z_m,force_gain,clutch\n"
                          "0,0.001,0,0,1e9,0\n0.001,0.002,0,0,inf,1\n0.002,0.0");

    const std::vector<PlayedRow> rows = read_trace(folder.path());

    REQUIRE(rows.size() == 2);
    CHECK(rows[1].handle_m.x() == 0.002);
    CHECK(rows[1].clutch);
}

TEST_CASE("a trace states the cap and the stops of the recorded device, else the scene's counts",
          "[devices][played]") {
    PlayedHandle handle({.rows = parse_trace(header.substr(0, header.size() - 1) +
                                                 ",cap_N_per_m,at_stop\n0,0.3,0,0,1234.5,0\n"
                                                 "0.001,0.3,0,0,1234.5,1\n",
                                             "trace.csv"),
                         .viscosity_N_s_per_m = 0.1});
    CHECK(handle.spec().cap_N_per_m == 1234.5);
    CHECK_FALSE(is_at_stop(handle.read(), handle.spec().half_workspace_m));
    CHECK(is_at_stop(after(handle, 1), handle.spec().half_workspace_m));

    PlayedHandle scripted(
        {.rows = parse_script(header + "0,0.3,0,0\n", "hand.csv"), .viscosity_N_s_per_m = 0.1});
    CHECK(scripted.spec().cap_N_per_m == 0);
    CHECK(scripted.spec().viscosity_N_s_per_m == 0.1);
}

TEST_CASE("a reset begins a script anew while its clock runs on", "[devices][played]") {
    HandOrders orders;
    PlayedHandle handle = play(header + "0,0,0,0\n0.1,0.1,0,0\n", &orders);
    CHECK_THAT(after(handle, 60).position_m.x(), WithinAbs(0.06, 1e-12));

    orders.post({.restarts = 1});

    CHECK_THAT(after(handle, 21).position_m.x(), WithinAbs(0.021, 1e-3 + 1e-12));
    CHECK_THAT(handle.read().time_s, WithinAbs(0.081, 1e-12));

    orders.post({.restarts = 1, .frozen = true});
    const double there = handle.read().position_m.x();
    CHECK(after(handle, 50).position_m.x() == there);
}

TEST_CASE("what cannot be played is told with its line", "[devices][played]") {
    using Catch::Contains;
    CHECK_THAT(told(""), Contains("hand.csv: has no rows"));
    CHECK_THAT(told(header), Contains("hand.csv: has no rows"));
    CHECK_THAT(told("\n0,0,0,0\n"), Contains("hand.csv:2: unknown column '0'"));
    CHECK_THAT(told("time_s,handle_x_m,handle_ym,handle_z_m\n"),
               Contains("did you mean 'handle_y_m'"));
    CHECK_THAT(told("time_s,handle_x_m,handle_y_m\n"), Contains("'handle_z_m' is missing"));
    CHECK_THAT(told("time_s,time_s\n"), Contains("'time_s' is repeated"));
    CHECK_THAT(told(header + "0,0,0\n"), Contains("hand.csv:2: the row has 3 values; expected 4"));
    CHECK_THAT(told(header + "0,0,0,0,0\n"),
               Contains("hand.csv:2: the row has 5 values; expected 4"));
    CHECK_THAT(told(header + "0,0,0,up\n"),
               Contains("hand.csv:2: 'up' is not a number; expected one for handle_z_m"));
    CHECK_THAT(told(header + "0,0,nan,0\n"), Contains("'nan' is not a number"));
    CHECK_THAT(told(header + "0,0,0,0\n0,0,0,0\n"),
               Contains("hand.csv:3: the time 0 s follows 0 s; expected ascending times"));
    CHECK_THAT(told(header + "0,0,20,0\n"), Contains("20 m from the middle; expected at most 0.5"));
    CHECK_THAT(told("at_stop," + header + "2,0,0,0,0\n"), Contains("at_stop is 2"));
    CHECK_THAT(told("clutch," + header + "2,0,0,0,0\n"), Contains("clutch is 2"));
    CHECK_THAT(test::load_error_of([] { (void)read_script("/nowhere/hand.csv"); }),
               Contains("/nowhere/hand.csv"));
}
