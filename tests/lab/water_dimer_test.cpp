// The dimer that scenes/water begins from.
#include "tools/lab/experiments/water_dimer.h"
#include "charmm/force_field.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <vector>

using namespace palpa;

namespace {

// The sum over nine pairs, written out.
double energy_of(const RigidWater& water, double distance, double acceptor, double donor) {
    const std::vector<Vec3> a = place_acceptor(water, acceptor),
                            d = place_donor(water, distance, donor);
    double energy = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const double r = (a[i] - d[j]).norm();
            const double ratio = std::pow((water.half_rmin[i] + water.half_rmin[j]) / r, 6);
            energy += 332.0716 * water.charge[i] * water.charge[j] / r +
                      water.sqrt_epsilon[i] * water.sqrt_epsilon[j] * ratio * (ratio - 2);
        }
    }
    return energy;
}

}  // namespace

TEST_CASE("two waters are lowest where no change of distance or direction lowers them",
          "[experiments]") {
    const RigidWater water = find_water(read_force_field(
        std::vector<std::filesystem::path>{test::in_project("scenes/water/tip3p.str")}));

    const WaterDimer lowest = find_lowest_dimer(water);

    CHECK(lowest.energy ==
          Approx(energy_of(water, lowest.distance, lowest.acceptor, lowest.donor)).epsilon(1e-9));
    CHECK(lowest.energy == Approx(-6.594).margin(0.005));
    CHECK(lowest.distance == Approx(2.767).margin(0.002));
    for (const double step : {-0.01, 0.01}) {
        CHECK(energy_of(water, lowest.distance + step, lowest.acceptor, lowest.donor) >
              lowest.energy);
        CHECK(energy_of(water, lowest.distance, lowest.acceptor + step, lowest.donor) >
              lowest.energy);
        CHECK(energy_of(water, lowest.distance, lowest.acceptor, lowest.donor + step) >
              lowest.energy);
    }
}
