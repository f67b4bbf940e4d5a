#include "math/superpose.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using namespace palpa;

namespace {

double square_distance(const RigidMotion& motion, const std::vector<Vec3>& from,
                       const std::vector<Vec3>& to) {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i) sum += (motion * from[i] - to[i]).squaredNorm();
    return sum;
}

}  // namespace

TEST_CASE("points that were moved as one are superposed exactly, mirror images are not",
          "[math][superpose]") {
    const std::vector<Vec3> from{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0.5, 0.5, 3}};
    const RigidMotion went = turn_about(Vec3(1, 2, 3), Vec3(1, -2, 0.5).normalized(), 2.5);
    std::vector<Vec3> to, mirrored;
    for (const Vec3& point : from) {
        to.push_back(went * point);
        mirrored.emplace_back(point.x(), point.y(), -point.z());
    }
    const RigidMotion found = superpose(from, to);
    CHECK((found.rotation - went.rotation).norm() < 1e-12);
    CHECK((found.translation - went.translation).norm() < 1e-12);

    const RigidMotion best = superpose(from, mirrored);
    CHECK(best.rotation.determinant() == Approx(1));
    CHECK(square_distance(best, from, mirrored) > 0.1);
}

TEST_CASE("no motion near the one found brings points nearer", "[math][superpose]") {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    const auto draw = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    for (int repeat = 0; repeat < 20; ++repeat) {
        std::vector<Vec3> from(7), to(7);
        for (Vec3& point : from) point = draw();
        for (Vec3& point : to) point = draw();
        const RigidMotion found = superpose(from, to);
        const double least = square_distance(found, from, to);
        for (int i = 0; i < 200; ++i) {
            RigidMotion other =
                turn_about(draw(), draw().normalized(), 0.1 * normal(random)) * found;
            if (i % 2 == 0)
                other = turn_about(draw(), draw().normalized(), 3 * normal(random)) * found;
            other.translation += 0.01 * draw();
            CHECK(square_distance(other, from, to) >= least);
        }
    }
}
