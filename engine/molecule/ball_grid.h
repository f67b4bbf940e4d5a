// A grid of atoms as balls, for neighbour queries.
#pragma once
#include "math/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

struct AtomBall {
    Vec3 centre{0, 0, 0};  // Å
    double radius = 0;     // Å
    std::uint32_t atom = 0;
};

// Balls sorted into cubic cells. Cells stand at multiples of their edge and are visited in the
// order of x, y and z, balls of a cell in the order of atoms: two balls always come in the same
// order, whatever the query, so that sums over them repeat to the bit.
class BallGrid {
public:
    BallGrid() = default;

    // Leaves out atoms whose radius is not above 0 or whose place is not finite. The edge (Å) is
    // the wanted one; far apart atoms get larger cells, so that there are not many more cells than
    // atoms.
    BallGrid(std::span<const Vec3> centres, std::span<const double> radii, double edge) {
        std::vector<AtomBall> balls;
        balls.reserve(centres.size());
        Vec3 low = Vec3::Constant(1e300), high = -low;
        for (std::uint32_t i = 0; i < centres.size(); ++i) {
            if (!(radii[i] > 0) || !centres[i].allFinite()) continue;
            balls.push_back({centres[i], radii[i], i});
            low = low.cwiseMin(centres[i]);
            high = high.cwiseMax(centres[i]);
            largest_radius_ = std::max(largest_radius_, radii[i]);
        }
        if (balls.empty()) return;
        const double most_cells = 64 * (static_cast<double>(balls.size()) + 64);
        edge_ = edge;
        while (((high - low).array() / edge_ + 1).prod() > most_cells) edge_ *= 2;
        for (int k = 0; k < 3; ++k) {
            first_[k] = std::floor(low[k] / edge_);
            cells_[k] = static_cast<std::ptrdiff_t>(std::floor(high[k] / edge_) - first_[k]) + 1;
        }
        sort(balls);
    }

    double largest_radius() const noexcept { return largest_radius_; }  // Å
    std::span<const AtomBall> balls() const noexcept { return balls_; }

    // Calls visit(ball) for every ball with its centre in the box, ends included.
    template <class Visit>
    void visit_box(const Vec3& low, const Vec3& high, const Visit& visit) const {
        any_run(low, high, [&](const AtomBall& ball) {
            if ((ball.centre.array() >= low.array()).all() &&
                (ball.centre.array() <= high.array()).all())
                visit(ball);
            return false;
        });
    }

    // Calls visit(ball, squared distance) for every ball whose centre is closer than `distance`.
    template <class Visit>
    void visit_near(const Vec3& place, double distance, const Visit& visit) const {
        const Vec3 reach = Vec3::Constant(distance);
        any_run(place - reach, place + reach, [&](const AtomBall& ball) {
            const double squared = (ball.centre - place).squaredNorm();
            if (squared < distance * distance) visit(ball, squared);
            return false;
        });
    }

    // Is test(ball, squared distance) true for any ball? Asked are all that are closer than
    // `distance` and some that are farther.
    template <class Test>
    bool any_near(const Vec3& place, double distance, const Test& test) const {
        const Vec3 reach = Vec3::Constant(distance);
        return any_run(place - reach, place + reach, [&](const AtomBall& ball) {
            return test(ball, (ball.centre - place).squaredNorm());
        });
    }

private:
    void sort(const std::vector<AtomBall>& balls) {
        starts_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
        std::vector<std::size_t> cell_of(balls.size());
        for (std::size_t i = 0; i < balls.size(); ++i) {
            std::array<std::ptrdiff_t, 3> c{};
            for (int k = 0; k < 3; ++k) c[k] = cell_along(k, balls[i].centre[k]);
            cell_of[i] = static_cast<std::size_t>((c[0] * cells_[1] + c[1]) * cells_[2] + c[2]);
            ++starts_[cell_of[i] + 1];
        }
        for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
        std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
        balls_.resize(balls.size());
        for (std::size_t i = 0; i < balls.size(); ++i) balls_[next[cell_of[i]]++] = balls[i];
    }

    std::ptrdiff_t cell_along(int axis, double place) const {
        const double cell = std::floor(place / edge_) - first_[axis];
        return static_cast<std::ptrdiff_t>(
            std::clamp(cell, -1.0, static_cast<double>(cells_[axis])));
    }

    // Cells along z are contiguous, and so are their balls.
    template <class Test>
    bool any_run(const Vec3& low, const Vec3& high, const Test& test) const {
        if (balls_.empty()) return false;
        std::array<std::ptrdiff_t, 3> from{}, to{};
        for (int k = 0; k < 3; ++k) {
            from[k] = std::max<std::ptrdiff_t>(cell_along(k, low[k]), 0);
            to[k] = std::min(cell_along(k, high[k]), cells_[k] - 1);
            if (from[k] > to[k]) return false;
        }
        for (std::ptrdiff_t x = from[0]; x <= to[0]; ++x) {
            for (std::ptrdiff_t y = from[1]; y <= to[1]; ++y) {
                const std::ptrdiff_t row = (x * cells_[1] + y) * cells_[2];
                const std::size_t end = starts_[static_cast<std::size_t>(row + to[2]) + 1];
                for (std::size_t i = starts_[static_cast<std::size_t>(row + from[2])]; i < end; ++i)
                    if (test(balls_[i])) return true;
            }
        }
        return false;
    }

    std::vector<AtomBall> balls_;
    std::vector<std::size_t> starts_;  // start of every cell, and the end
    double edge_ = 1;                  // Å
    double largest_radius_ = 0;
    std::array<double, 3> first_{};  // first cell, by its number from the origin
    std::array<std::ptrdiff_t, 3> cells_{};
};

}  // namespace palpa
