#include "molecule/accessible_area.h"

#include "molecule/ball_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace palpa {
namespace {

// Points on a sphere of radius 1, each the same turn about z behind the last, the golden section of
// a whole one, and in slices of the same height, which have the same area.
std::vector<Vec3> spread_points(std::size_t count) {
    std::vector<Vec3> points;
    constexpr double turn = 2 * std::numbers::pi / std::numbers::phi;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
        const double out = std::sqrt(1 - z * z), angle = turn * static_cast<double>(i);
        points.emplace_back(out * std::cos(angle), out * std::sin(angle), z);
    }
    return points;
}

// A neighbour hides the points of a unit sphere whose component along `direction` is above
// `height`.
struct Cap {
    Vec3 direction{0, 0, 1};
    double height = 0;
};

// False where a neighbour hides everything.
bool find_caps(const BallGrid& grid, const AtomBall& ball, double probe, std::vector<Cap>& caps) {
    caps.clear();
    const double radius = ball.radius + probe;
    bool is_free = true;
    grid.visit_near(ball.centre, radius + grid.largest_radius() + probe,
                    [&](const AtomBall& other, double squared) {
                        const double other_radius = other.radius + probe;
                        if (other.atom == ball.atom) return;
                        const double distance = std::sqrt(squared);
                        if (distance >= radius + other_radius) return;
                        // Of two balls at one place the first, or the larger, has the area.
                        const double larger = other_radius - radius;
                        if (distance <= std::abs(larger)) {
                            if (larger > 0 || (larger == 0 && other.atom < ball.atom))
                                is_free = false;
                            return;
                        }
                        const double along =
                            (squared + radius * radius - other_radius * other_radius) /
                            (2 * distance);
                        caps.push_back({(other.centre - ball.centre) / distance, along / radius});
                    });
    // Those that hide most are asked first.
    std::ranges::sort(caps, {}, &Cap::height);
    return is_free;
}

}  // namespace

std::vector<double> find_accessible_areas(std::span<const Vec3> positions,
                                          std::span<const double> radii, double probe,
                                          std::size_t points) {
    constexpr double grid_edge = 3;  // Å
    const BallGrid grid(positions, radii, grid_edge);
    const std::vector<Vec3> unit_points = spread_points(points);
    std::vector<double> areas(positions.size(), 0);
    std::vector<Cap> caps;
    for (const AtomBall& ball : grid.balls()) {
        if (!find_caps(grid, ball, probe, caps)) continue;
        std::size_t free = 0, last = 0;
        for (const Vec3& point : unit_points) {
            const auto hides = [&](const Cap& cap) {
                return cap.direction.dot(point) > cap.height;
            };
            // The cap that hid the last point often hides this one.
            if (last < caps.size() && hides(caps[last])) continue;
            last = static_cast<std::size_t>(std::ranges::find_if(caps, hides) - caps.begin());
            if (last == caps.size()) ++free;
        }
        const double radius = ball.radius + probe;
        areas[ball.atom] = 4 * std::numbers::pi * radius * radius * static_cast<double>(free) /
                           static_cast<double>(points);
    }
    return areas;
}

}  // namespace palpa
