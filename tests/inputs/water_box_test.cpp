#include "inputs/water_box.h"

#include "charmm/force_field.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

ForceField tip3p() {
    const std::array<std::filesystem::path, 1> files{test::in_project("scenes/water/tip3p.str")};
    return read_force_field(files);
}

double image_distance(const Vec3& a, const Vec3& b, double edge) {
    Vec3 way = a - b;
    for (double& each : way) each -= edge * std::round(each / edge);
    return way.norm();
}

}  // namespace

TEST_CASE("a box of water has water's density and bonds, and no atoms on each other",
          "[inputs][water]") {
    const ForceField force_field = tip3p();
    const WaterBox box = build_water_box(force_field, {}, {}, {});

    CHECK(box.waters == 216);
    CHECK(216 / std::pow(box.edge, 3) == Approx(0.0334));
    REQUIRE(box.positions.size() == 648);
    for (std::size_t first = 0; first < 648; first += 3) {
        CHECK((box.positions[first + 1] - box.positions[first]).norm() == Approx(0.9572));
        CHECK((box.positions[first + 2] - box.positions[first]).norm() == Approx(0.9572));
    }
    double closest = 10;
    for (std::size_t i = 0; i < 648; ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (i / 3 != j / 3)
                closest =
                    std::min(closest, image_distance(box.positions[i], box.positions[j], box.edge));
    // A hydrogen bond is 1.8 Å long; nothing else is shorter.
    CHECK(closest > 1.4);
    CHECK(build_water_box(force_field, {}, {}, {}).positions == box.positions);
}

TEST_CASE("waters are turned so that hydrogens point at oxygens", "[inputs][water]") {
    const WaterBox box = build_water_box(tip3p(), {}, {}, {});
    // In ice each hydrogen has an oxygen of another water within 2.5 Å; of random ones a third.
    int bonded = 0;
    for (std::size_t hydrogen = 0; hydrogen < 648; ++hydrogen) {
        if (hydrogen % 3 == 0) continue;
        for (std::size_t oxygen = 0; oxygen < 648; oxygen += 3) {
            if (oxygen / 3 == hydrogen / 3) continue;
            if (image_distance(box.positions[hydrogen], box.positions[oxygen], box.edge) < 2.2) {
                ++bonded;
                break;
            }
        }
    }
    CHECK(bonded > 0.8 * 432);
}

TEST_CASE("waters leave a molecule its room", "[inputs][water]") {
    Connectivity ion;
    ion.file = "ion.psf";
    ion.names = {{"I", "ION", "1", "O"}};
    ion.type = {"OT"};
    ion.charge = {0};
    ion.mass = {15.9994};
    ion.lines = {1};
    const WaterBox box = build_water_box(tip3p(), ion, {Vec3(100, 0, 0)}, {});
    CHECK(box.waters < 216);
    CHECK(box.waters > 210);
    CHECK(box.positions[0].isApprox(Vec3::Constant(box.edge / 2)));
    for (std::size_t oxygen = 1; oxygen < box.positions.size(); oxygen += 3)
        CHECK(image_distance(box.positions[oxygen], box.positions[0], box.edge) >= 2.6);

    ion.names[0].segment = "WATA";
    CHECK_THAT(load_error_of([&] { (void)build_water_box(tip3p(), ion, {Vec3(0, 0, 0)}, {}); }),
               Contains("does not begin with WAT"));
}
