// Steps of large rigid molecules have pairs in single precision: against the same in double.
#include "core/units.h"
#include "scene/read_scene.h"
#include "simulation/held.h"
#include "simulation/load.h"
#include "simulation/probe.h"
#include "tests/support/paths.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

TEST_CASE("explore", "[simulation][fast]") {
    constexpr double pN = units::piconewton_per_kcal_per_mol_angstrom;
    for (const char* file : {"scene.toml", "charged", "surface.toml"}) {
        World world = load_world(read_scene(test::in_project("scenes/hiv") / file, std::vector<std::string>{}));
        const Entity hand = first_hand(world);
        const MoleculePose start = grip_of(world, hand).pose;
        std::mt19937 random(5);
        std::uniform_real_distribution<double> uniform(-1, 1);
        const auto vec = [&] { const double x = uniform(random), y = uniform(random), z = uniform(random); return Vec3(x, y, z); };
        for (const auto& [reach, angle] : {std::pair{0.3, 0.05}, {1.0, 0.3}, {5.0, 3.0}, {60.0, 3.0}, {1000.0, 3.0}}) {
            double ef = 0, et = 0, ek = 0, ee = 0, rf = 0, rt = 0, rk = 0, re = 0, maxf = 0, minf = 1e99;
            int same = 0;
            for (int i = 0; i < 60; ++i) {
                const Vec3 turn = angle * vec();
                place_grabbed(world, MoleculePose{start.place_angstrom + reach * vec(), Quat(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * start.orientation}, hand);
                const FieldSum exact = field_on_held(world, hand), fast = fast_field_on_held(world, hand);
                const Vec3 centre = centre_of_mass(world.resource<AtomTable>(), held_range(world, hand));
                const double f = (fast.force - exact.force).norm() * pN, F = exact.force.norm() * pN;
                const double t = (fast.torque_about(centre) - exact.torque_about(centre)).norm() * pN, T = exact.torque_about(centre).norm() * pN;
                const double k = (fast.stiffness - exact.stiffness).norm() * pN * 1e-2, K = exact.stiffness.norm() * pN * 1e-2;
                const double e = std::max(std::abs(fast.van_der_waals - exact.van_der_waals), std::abs(fast.electrostatic - exact.electrostatic)), E = std::max(std::abs(exact.electrostatic), std::abs(exact.van_der_waals));
                if (f == 0) ++same;
                maxf = std::max(maxf, F); minf = std::min(minf, F);
                if (F < 1e4) { ef = std::max(ef, f); et = std::max(et, t); ek = std::max(ek, k); ee = std::max(ee, e); }
                rf = std::max(rf, f / F); rt = std::max(rt, t / T); rk = std::max(rk, k / K); re = std::max(re, e / E);
            }
            std::printf("%s reach %g: F %g to %g, %d same; weak: force %.2g pN torque %.2g pN A stiff %.2g N/m energy %.2g; rel %.2g %.2g %.2g %.2g\n", file, reach, minf, maxf, same, ef, et, ek, ee, rf, rt, rk, re);
        }
    }
}
