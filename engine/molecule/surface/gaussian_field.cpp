#include "molecule/surface/gaussian_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpa {
namespace {

constexpr double largest_exponent = 7;

// exp(-k (x - c)^2 + shift) at a block's points along one axis; only those within reach.
struct AxisTable {
    std::array<float, block_points> value{};
    int first = 0, last = -1;
};

AxisTable tabulate(std::int32_t block, double spacing, double centre, double k, double reach,
                   double shift) {
    AxisTable table;
    const double start = point_coordinate(block, 0, spacing);
    table.first = std::max(0, static_cast<int>(std::ceil((centre - reach - start) / spacing)) - 1);
    table.last =
        std::min(block_cells, static_cast<int>(std::floor((centre + reach - start) / spacing)) + 1);
    for (int i = table.first; i <= table.last; ++i) {
        const double x = point_coordinate(block, i, spacing) - centre;
        if (std::abs(x) > reach) continue;  // decided from the point alone
        table.value[static_cast<std::size_t>(i)] = std::exp(static_cast<float>(shift - k * x * x));
    }
    return table;
}

}  // namespace

double GaussianField::reach(double radius) const noexcept {
    return radius * std::sqrt(1 + largest_exponent / sharpness_);
}

void GaussianField::move(const BallGrid& grid, std::span<const MovedBall> /*moved*/) {
    grid_ = &grid;
}

bool GaussianField::sample(const BlockIndex& block, BlockSamples& samples) {
    bool has_any = false;
    BlockSamples sum;
    const Vec3 low = block_corner(block, spacing_);
    const Vec3 high = low + Vec3::Constant(block_cells * spacing_);
    const Vec3 margin = Vec3::Constant(reach(grid_->largest_radius()));
    grid_->visit_box(low - margin, high + margin, [&](const AtomBall& ball) {
        const double k = sharpness_ / (ball.radius * ball.radius), far = reach(ball.radius);
        const Vec3& c = ball.centre;
        if (((c.array() + far) < low.array()).any() || ((c.array() - far) > high.array()).any())
            return;
        if (!has_any) sum.fill(0);
        has_any = true;
        // A Gaussian is the product of three, one along each axis.
        const AxisTable x = tabulate(block[0], spacing_, c[0], k, far, 0);
        const AxisTable y = tabulate(block[1], spacing_, c[1], k, far, 0);
        const AxisTable z = tabulate(block[2], spacing_, c[2], k, far, sharpness_);
        for (int iz = z.first; iz <= z.last; ++iz) {
            for (int iy = y.first; iy <= y.last; ++iy) {
                const float yz =
                    z.value[static_cast<std::size_t>(iz)] * y.value[static_cast<std::size_t>(iy)];
                float* const row = &sum[point_index(0, iy, iz)];
                for (std::size_t ix = 0; ix < block_points; ++ix) row[ix] += yz * x.value[ix];
            }
        }
    });
    if (!has_any) return false;
    // A logarithm changes more evenly between two points.
    const float least = std::exp(static_cast<float>(-2 * largest_exponent));
    // Whole packets: a single remaining number would be taken by another logarithm, and the last
    // point of a block, a corner that others share, would differ in its last bit.
    constexpr std::size_t widest = 16;
    constexpr std::size_t padded = (points_of_block + widest - 1) / widest * widest;
    Eigen::Array<float, padded, 1> logarithms;
    logarithms.setConstant(least);
    std::ranges::copy(sum, logarithms.begin());
    logarithms = logarithms.max(least).log().eval();
    std::copy_n(logarithms.begin(), points_of_block, samples.begin());
    return true;
}

// The surface's point to first order; normal and atom are still those of the place asked for.
SurfacePoint GaussianField::step_to_surface(const Vec3& from) const {
    double sum = 0, nearest = std::numeric_limits<double>::infinity();
    Vec3 gradient = Vec3::Zero();
    SurfacePoint point{from, Vec3::UnitZ(), 0};
    grid_->visit_near(from, reach(grid_->largest_radius()),
                      [&](const AtomBall& ball, double squared) {
                          const double k = sharpness_ / (ball.radius * ball.radius);
                          const double exponent = sharpness_ - k * squared;
                          if (exponent > -largest_exponent) {
                              const double term = std::exp(static_cast<float>(exponent));
                              sum += term;
                              gradient -= 2 * k * term * (from - ball.centre);
                          }
                          const double gap = std::sqrt(squared) - ball.radius;
                          if (gap < nearest) {
                              nearest = gap;
                              point.atom = ball.atom;
                          }
                      });
    const double slope = gradient.norm();
    if (slope == 0 || sum <= 0) return point;
    point.normal = -gradient / slope;
    // One step of Newton for ln sum = 0.
    const double most = 0.25 * spacing_;
    point.place += point.normal * std::clamp(sum * std::log(sum) / slope, -most, most);
    return point;
}

SurfacePoint GaussianField::refine(const Vec3& near) {
    const SurfacePoint point = step_to_surface(near);
    if ((point.place - near).norm() < 0.02 * spacing_) return point;
    return step_to_surface(point.place);
}

}  // namespace palpa
