#include "molecule/point_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

// Beyond it differences of squares overflow, and nothing has an atom there.
constexpr double farthest_point = 1e100;  // Å

bool is_placed(const Vec3& place) noexcept {
    return place.allFinite() && place.cwiseAbs().maxCoeff() < farthest_point;
}

}  // namespace

PointGrid::PointGrid(std::vector<Vec3> points, double edge) : points_(std::move(points)) {
    std::size_t count = 0;
    for (const Vec3& point : points_) {
        if (!is_placed(point)) continue;
        low_ = count == 0 ? point : low_.cwiseMin(point);
        high_ = count == 0 ? point : high_.cwiseMax(point);
        ++count;
    }
    const Vec3 extent = high_ - low_;
    const double room = (extent.array() + 1.0).prod();
    edge_ = std::max(edge, std::cbrt(8 * room / (static_cast<double>(count) + 1)));
    // Points along a line fill few of the cells of that room.
    const auto cells = [&] { return ((extent / edge_).array().floor() + 1).prod(); };
    while (cells() > 8 * static_cast<double>(count) + 64) edge_ *= 1.5;
    for (std::size_t k = 0; k < 3; ++k) {
        const double along = extent[static_cast<Eigen::Index>(k)] / edge_;
        cells_[k] = static_cast<std::uint32_t>(along) + 1;
    }

    first_.assign(index(cells_[0] - 1, cells_[1] - 1, cells_[2] - 1) + 2, 0);
    const auto index_of = [&](const Vec3& point) {
        const auto [x, y, z] = cell_of(point);
        return index(x, y, z);
    };
    for (const Vec3& point : points_)
        if (is_placed(point)) ++first_[index_of(point) + 1];
    for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    order_.resize(count);
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < points_.size(); ++i)
        if (is_placed(points_[i])) order_[next[index_of(points_[i])]++] = i;
}

bool PointGrid::is_out_of_reach(const Vec3& place, double radius) const noexcept {
    const bool is_within =
        ((place - low_).array() >= -radius).all() && ((place - high_).array() <= radius).all();
    return !is_within;  // of a place that is not finite as well
}

std::array<std::uint32_t, 3> PointGrid::cell_of(const Vec3& place) const noexcept {
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        const double at = std::floor((place[axis] - low_[axis]) / edge_);
        cell[k] = static_cast<std::uint32_t>(std::clamp(at, 0.0, cells_[k] - 1.0));
    }
    return cell;
}

PointGrid::Block PointGrid::block_around(const Vec3& place, double radius) const noexcept {
    return {cell_of(place - Vec3::Constant(radius)), cell_of(place + Vec3::Constant(radius))};
}

}  // namespace palpa
