#include "molecule/accessible_area.h"

#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;

namespace {

using std::numbers::pi;

struct Peer {
    std::vector<Vec3> positions;
    std::vector<double> radii, areas;
};

Peer read_peer(const std::string& structure) {
    std::ifstream file(test::test_data("accessible_area.csv"));
    Peer peer;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(structure + ",")) continue;
        double x = 0, y = 0, z = 0, radius = 0, area = 0;
        REQUIRE(std::sscanf(line.c_str() + structure.size(), ",%lf,%lf,%lf,%lf,%lf", &x, &y, &z,
                            &radius, &area) == 5);
        peer.positions.emplace_back(x, y, z);
        peer.radii.push_back(radius);
        peer.areas.push_back(area);
    }
    return peer;
}

}  // namespace

TEST_CASE("accessible areas are those of FreeSASA", "[molecule][area]") {
    const auto* const structure = GENERATE("1crn", "1ubq");
    INFO(structure);
    const Peer peer = read_peer(structure);
    REQUIRE(peer.areas.size() > 300);

    const std::vector<double> areas = find_accessible_areas(peer.positions, peer.radii);
    const std::vector<double> finer = find_accessible_areas(peer.positions, peer.radii, 1.4, 20000);

    double sum = 0, peer_sum = 0, square = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        INFO("atom " << i);
        sum += areas[i];
        peer_sum += peer.areas[i];
        square += (areas[i] - peer.areas[i]) * (areas[i] - peer.areas[i]);
        // A point stands for 0.6 Å^2, and few are on the edges of what is free.
        CHECK(areas[i] == Approx(peer.areas[i]).epsilon(0.05).margin(3.5));
        CHECK(finer[i] == Approx(peer.areas[i]).epsilon(0.005).margin(0.1));
    }
    CHECK(sum == Approx(peer_sum).epsilon(0.01));
    CHECK(std::sqrt(square / static_cast<double>(areas.size())) < 0.7);
}

TEST_CASE("two spheres hide a cap of each other", "[molecule][area]") {
    // Zones of a sphere have the area 2 pi R height.
    const double r1 = 1.7, r2 = 1.2, d = 2.2, probe = 1.4;
    const double R_1 = r1 + probe, R_2 = r2 + probe;
    const double to_plane = (d * d + R_1 * R_1 - R_2 * R_2) / (2 * d);

    const std::vector<double> areas = find_accessible_areas(
        std::vector<Vec3>{{1, 2, 3}, {1, 2, 3 + d}}, std::vector<double>{r1, r2}, probe, 20000);

    CHECK(areas[0] == Approx(2 * pi * R_1 * (R_1 + to_plane)).epsilon(0.001));
    CHECK(areas[1] == Approx(2 * pi * R_2 * (R_2 + d - to_plane)).epsilon(0.001));
}

TEST_CASE("what is within another sphere or at its place has its area once", "[molecule][area]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Vec3> positions{{0, 0, 0},  {0.1, 0, 0}, {50, 0, 0},
                                      {50, 0, 0}, {90, 0, 0},  {nan, 0, 0}};
    const std::vector<double> radii{1.8, 1.0, 1.5, 1.5, 0, 1.5};

    const std::vector<double> areas = find_accessible_areas(positions, radii);

    CHECK(areas[0] == Approx(4 * pi * 3.2 * 3.2));
    CHECK(areas[1] == 0);
    CHECK(areas[2] == Approx(4 * pi * 2.9 * 2.9));
    CHECK(areas[3] == 0);
    CHECK(areas[4] == 0);
    CHECK(areas[5] == 0);
    CHECK(find_accessible_areas({}, {}).empty());
}
