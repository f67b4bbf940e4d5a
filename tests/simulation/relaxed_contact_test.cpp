// What hands feel between steps where everything follows them by second order.
#include "simulation/relaxed_contact.h"

#include "core/units.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/step.h"
#include "simulation/systems/publish_contact.h"
#include "tests/support/paths.h"
#include "tests/support/step_once.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

Mat6 random_symmetric(std::mt19937& random, double size) {
    std::normal_distribution<double> normal(0, size);
    const Mat6 m = Mat6::NullaryExpr([&] { return normal(random); });
    return 0.5 * (m + m.transpose());
}

double lowest(const Mat6& m) {
    return Eigen::SelfAdjointEigenSolver<Mat6>(m).eigenvalues().minCoeff();
}

const std::vector<std::string> by_second_order{"statics.method=\"second-order\""};

World load_pocket() {
    return load_world(read_scene(test::in_project("scenes/hiv/flexible.toml"), by_second_order));
}

// The servo has put it there.
HandPose pose_at(const MoleculePose& start, const Vec3& by) {
    HandPose pose;
    pose.molecule = start;
    pose.molecule->place_angstrom += by;
    return pose;
}

}  // namespace

TEST_CASE("the served stiffness is within its bounds, and the relaxed one where that is",
          "[simulation][relaxed]") {
    std::mt19937 random(27);
    for (int i = 0; i < 100; ++i) {
        const Mat6 noise = random_symmetric(random, 30);
        const Mat6 frozen = 0.1 * noise * noise + random_symmetric(random, 0.3);
        const Mat6 relaxed = random_symmetric(random, 20);

        const Mat6 served = bound_stiffness(relaxed, frozen, 5);

        CHECK(lowest(served) > -5 - 1e-9);
        CHECK(lowest(frozen - served) > -1e-9 * frozen.norm());
        // A relaxed stiffness that is less than the frozen one, and above the bound.
        const Mat6 soft = 0.5 * (frozen - 4 * Mat6::Identity());
        if (lowest(soft) < -5) continue;
        CHECK((bound_stiffness(soft, frozen, 5) - soft).norm() < 1e-9 * frozen.norm());
    }
}

TEST_CASE("from contact to contact no direction changes by more than the limit",
          "[simulation][relaxed]") {
    std::mt19937 random(28);
    for (int i = 0; i < 100; ++i) {
        const Mat6 last = random_symmetric(random, 20), now = random_symmetric(random, 20);
        const Mat6 served = limit_change(last, now, 3);
        CHECK(lowest(served - last) > -3 - 1e-9);
        CHECK(lowest(last - served) > -3 - 1e-9);
        CHECK((limit_change(last, now, 1e3) - now).norm() < 1e-9);
    }
}

TEST_CASE("between steps of 83 ms the force in a pocket is that of complete following",
          "[simulation][relaxed][hiv]") {
    World world = load_pocket(), every_tick = load_pocket();
    const MoleculePose start = contact_at(world, 0).model.molecule;
    constexpr double period_s = 0.083, tick_s = 0.00415, angstrom_per_s = 1;
    constexpr int periods = 6, ticks = 20;  // on +x a side chain snaps soon after
    const Vec3 way = Vec3::Unit(GENERATE(0, 1, 2)) * GENERATE(1.0, -1.0);
    const auto place_at = [&](double time_s) { return Vec3(time_s * angstrom_per_s * way); };
    const auto step_to = [&](World& w, double time_s) {
        (void)test::step_once(w, pose_at(start, place_at(time_s)), contact_at(w, 0).model);
        return contact_at(w, 0);
    };

    step_to(world, 0);
    const Vec3 first = step_to(every_tick, 0).model.force_newton;
    LocalContactModel made = step_to(world, 0), felt;
    double error2 = 0, change2 = 0, held2 = 0;
    int count = 0;
    for (int period = 1; period <= periods; ++period) {
        felt = made;  // of the pose at the last period's begin
        made = step_to(world, period * period_s);
        for (int tick = 1; tick <= ticks; ++tick) {
            const double now = period * period_s + tick * tick_s;
            const Vec3 truth = step_to(every_tick, now).model.force_newton;
            const Vec3 predicted =
                evaluate_local(felt.model, felt.field, *pose_at(start, place_at(now)).molecule)
                    .force_newton;
            error2 += (predicted - truth).squaredNorm();
            held2 += (felt.model.force_newton - truth).squaredNorm();
            change2 += (truth - first).squaredNorm();
            ++count;
        }
    }
    INFO("along " << way.transpose() << ": rms change " << 1e12 * std::sqrt(change2 / count)
                  << " pN, " << 1e12 * std::sqrt(held2 / count)
                  << " of it since the contact model; off by " << 1e12 * std::sqrt(error2 / count));
    CHECK(std::sqrt(error2) < 0.1 * std::sqrt(change2));
    CHECK(std::sqrt(error2) < 0.15 * std::sqrt(held2));
}
