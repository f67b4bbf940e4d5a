// The excluded surface against closed formulas of few spheres, and against what defines it.
#include "molecule/surface/excluded_field.h"

#include "molecule/surface/surface_cache.h"
#include "tests/support/closed_mesh.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace palpa;

namespace {

using std::numbers::pi;

struct Size {
    double area = 0, volume = 0;  // Å^2, Å^3
};

SurfaceMesh surface_of(const std::vector<Vec3>& places, const std::vector<double>& radii,
                       double spacing, double probe = 1.4) {
    return build_surface(places, radii,
                         {.kind = SurfaceKind::Excluded, .spacing = spacing, .probe = probe});
}

// The excluded surface of spheres has a patch of a sphere where the probe touches one, of a torus
// where it rolls along two and of the probe where it lies in a hollow of three (M. L. Connolly, J.
// Appl. Cryst. 16, 548 (1983)). Its volume: cones from the centres of atoms to the patches of
// spheres; for tori what the triangle of two centres and the probe's sweeps, less the probe's part;
// for hollows a tetrahedron less the probe's part.
Size excluded_by_two(double r1, double r2, double distance, double p) {
    const double R_1 = r1 + p, R_2 = r2 + p;
    const double t1 = (distance * distance + R_1 * R_1 - R_2 * R_2) / (2 * distance);
    const double t2 = distance - t1, ring = std::sqrt(R_1 * R_1 - t1 * t1);
    const double solid1 = 2 * pi * (1 + t1 / R_1), solid2 = 2 * pi * (1 + t2 / R_2);
    const double bend = std::atan2(t1, ring) + std::atan2(t2, ring), sines = t1 / R_1 + t2 / R_2;
    return {r1 * r1 * solid1 + r2 * r2 * solid2 + 2 * pi * p * (ring * bend - p * sines),
            (r1 * r1 * r1 * solid1 + r2 * r2 * r2 * solid2) / 3 +
                2 * pi *
                    (ring * ring * distance / 6 - ring * p * p * bend / 2 + p * p * p * sines / 3)};
}

// Three of the same radius, each at the same distance from the others.
Size excluded_by_three(double r, double d, double p) {
    const double R = r + p, ring = std::sqrt(R * R - d * d / 4), sine = d / 2 / R;
    const double height = std::sqrt(R * R - d * d / 3);  // of the probe above the triangle
    const double turn = 2 * pi - 2 * std::acos(d / (2 * std::sqrt(3.0)) / ring);
    // Caps that the neighbours cut out of an atom's sphere, with half-angle acos(sine); the angle
    // between their edges by the law of cosines, and the rest of the sphere by Gauss and Bonnet.
    const double between = std::acos((0.5 - sine * sine) / (1 - sine * sine));
    const double solid = 2 * turn * sine + 2 * (pi - between);
    const double side = 1 - d * d / (2 * R * R);  // cosine of the hollow's side
    const double hollow = 3 * std::acos(side / (1 + side)) - pi;
    const double bend = 2 * std::asin(sine), sines = 2 * sine;
    return {3 * r * r * solid + 3 * turn * p * (ring * bend - p * sines) + 2 * p * p * hollow,
            r * r * r * solid +
                3 * turn * (ring * ring * d / 6 - ring * p * p * bend / 2 + p * p * p * sines / 3) +
                2 * (std::sqrt(3.0) / 4 * d * d * height / 3 - p * p * p * hollow / 3)};
}

}  // namespace

TEST_CASE("a lone atom's excluded surface is its sphere", "[molecule][surface]") {
    const double r = 1.7;
    const SurfaceMesh mesh = surface_of({{0.3, -0.2, 0.1}}, {r}, 0.2);

    CHECK(find_area(mesh) == Approx(4 * pi * r * r).epsilon(0.005));
    CHECK(find_volume(mesh) == Approx(4 * pi / 3 * r * r * r).epsilon(0.01));
    for (std::size_t i = 0; i < mesh.places.size(); ++i) {
        const Vec3 out = mesh.places[i].cast<double>() - Vec3(0.3, -0.2, 0.1);
        CHECK(out.norm() == Approx(r).margin(1e-6));
        CHECK((out / r - mesh.normals[i].cast<double>()).norm() < 1e-5);
        CHECK(mesh.atoms[i] == 0);
    }
    CHECK(test::count_mesh(mesh.indices).euler == 2);
}

TEST_CASE("two atoms are joined by a saddle, with the formula's area and volume",
          "[molecule][surface]") {
    struct Case {
        double r1, r2, distance;
    };
    const Case c = GENERATE(Case{1.7, 1.7, 1.5}, Case{1.7, 1.2, 1.1}, Case{1.52, 1.8, 3.0},
                            Case{1.7, 1.7, 3.4});
    INFO(c.r1 << ", " << c.r2 << " at " << c.distance);
    const Vec3 direction = Vec3(1, 2, -0.5).normalized();
    const Size exact = excluded_by_two(c.r1, c.r2, c.distance, 1.4);

    double error = 0;
    for (const double spacing : {0.4, 0.2}) {
        const SurfaceMesh mesh =
            surface_of({Vec3(0.1, 0.2, 0.3), Vec3(0.1, 0.2, 0.3) + c.distance * direction},
                       {c.r1, c.r2}, spacing);

        CHECK(test::count_mesh(mesh.indices).is_closed);
        CHECK(test::count_mesh(mesh.indices).euler == 2);
        CHECK(find_area(mesh) == Approx(exact.area).epsilon(0.15 * spacing * spacing));
        CHECK(find_volume(mesh) == Approx(exact.volume).epsilon(0.25 * spacing * spacing));
        const double now = std::abs(find_volume(mesh) - exact.volume);
        // Flat triangles on a curved surface: the error goes with the spacing's square.
        if (error > 0) CHECK(now < error / 3);
        error = now;
    }
}

TEST_CASE("three atoms leave two hollows for the probe, with the formula's area and volume",
          "[molecule][surface]") {
    const double d = GENERATE(1.5, 2.6, 3.4);
    INFO("at " << d);
    const std::vector<Vec3> places{
        {0.1, 0.2, 0.3}, {0.1 + d, 0.2, 0.3}, {0.1 + d / 2, 0.2 + d / 2, 0.3 + d / std::sqrt(2.0)}};
    REQUIRE((places[2] - places[1]).norm() == Approx(d));
    const Size exact = excluded_by_three(1.7, d, 1.4);

    const SurfaceMesh mesh = surface_of(places, {1.7, 1.7, 1.7}, 0.2);

    CHECK(test::count_mesh(mesh.indices).is_closed);
    CHECK(test::count_mesh(mesh.indices).euler == 2);
    CHECK(find_area(mesh) == Approx(exact.area).epsilon(0.005));
    CHECK(find_volume(mesh) == Approx(exact.volume).epsilon(0.01));
    // Without a probe: the union of spheres has less volume, and nothing in its crevices.
    const SurfaceMesh spheres = surface_of(places, {1.7, 1.7, 1.7}, 0.2, 0);
    CHECK(find_volume(spheres) < 0.99 * exact.volume);
}

TEST_CASE("without a probe the excluded volume is that of the union of spheres",
          "[molecule][surface]") {
    const double r = 1.7, d = 1.9;

    const SurfaceMesh mesh = surface_of({{0, 0, 0}, {d, 0, 0}}, {r, r}, 0.1, 0);

    // Two spheres less their lens.
    const double lens = pi / 12 * (4 * r + d) * (2 * r - d) * (2 * r - d);
    CHECK(find_volume(mesh) == Approx(8 * pi / 3 * r * r * r - lens).epsilon(0.005));
    CHECK(find_area(mesh) == Approx(4 * pi * r * (r + d / 2)).epsilon(0.005));
}

TEST_CASE("the surface of a cloud of atoms is a probe's radius from all that its centre can reach",
          "[molecule][surface]") {
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> place(-5, 5), size(1.2, 1.8);
    std::vector<Vec3> places;
    std::vector<double> radii;
    for (int i = 0; i < 70; ++i) {
        places.emplace_back(place(engine), place(engine), place(engine));
        radii.push_back(size(engine));
    }
    const double probe = 1.4;
    const auto room_at = [&](const Vec3& centre) {
        double room = 1e9;
        for (std::size_t i = 0; i < places.size(); ++i)
            room = std::min(room, (centre - places[i]).norm() - radii[i] - probe);
        return room;
    };
    // Centres that touch an atom and hit none.
    std::vector<Vec3> centres;
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (int k = 0; k < 3000; ++k) {
            const Vec3 direction =
                Vec3(normal(engine), normal(engine), normal(engine)).normalized();
            const Vec3 centre = places[i] + (radii[i] + probe) * direction;
            if (room_at(centre) > -1e-9) centres.push_back(centre);
        }
    }
    REQUIRE(centres.size() > 2000);

    const SurfaceMesh mesh = surface_of(places, radii, 0.7);

    CHECK(test::count_mesh(mesh.indices).is_closed);
    REQUIRE(mesh.places.size() > 500);
    for (std::size_t i = 0; i < mesh.places.size(); ++i) {
        const Vec3 at = mesh.places[i].cast<double>(), normal_at = mesh.normals[i].cast<double>();
        CHECK(normal_at.norm() == Approx(1).margin(1e-5));
        CHECK(room_at(at + probe * normal_at) == Approx(0).margin(1e-4));
        double nearest = 1e9;
        for (const Vec3& centre : centres) nearest = std::min(nearest, (centre - at).norm());
        CHECK(nearest > probe - 1e-4);
        CHECK(nearest < probe + 0.3);
        // No other atom is nearer than the one that the vertex names.
        const std::size_t atom = mesh.atoms[i];
        const double gap = (at - places[atom]).norm() - radii[atom];
        CHECK(gap < room_at(at) + probe + 0.05);
    }
}

TEST_CASE("atoms at one place and atoms in a square do not confuse the probe",
          "[molecule][surface]") {
    // Twice the same three atoms; and a probe that touches four at once.
    const std::vector<Vec3> three{{0, 0, 0}, {2, 0, 0}, {1, 1.7, 0}};
    std::vector<Vec3> twice = three;
    twice.insert(twice.end(), three.begin(), three.end());
    const std::vector<Vec3> square{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {3, 3, 0}};

    const double once_volume = find_volume(surface_of(three, {1.7, 1.7, 1.7}, 0.3));
    const double twice_volume = find_volume(surface_of(twice, std::vector<double>(6, 1.7), 0.3));
    const SurfaceMesh mesh = surface_of(square, std::vector<double>(4, 1.7), 0.3);

    CHECK(twice_volume == Approx(once_volume).epsilon(1e-6));
    CHECK(test::count_mesh(mesh.indices).euler == 2);
    // Above the square's middle the probe comes down to its lowest place.
    const double lowest = std::sqrt(3.1 * 3.1 - 4.5) - 1.4;
    double nearest = 1e9, height = 0;
    for (const Eigen::Vector3f& at : mesh.places) {
        const double across = std::hypot(at.x() - 1.5F, at.y() - 1.5F);
        if (at.z() < 0 || across > nearest) continue;
        nearest = across;
        height = static_cast<double>(at.z());
    }
    CHECK(height == Approx(lowest).margin(0.02));
}
