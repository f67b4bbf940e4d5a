#include "molecule/surface/excluded_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

// Of lengths, Å: what touches is not inside.
constexpr double margin = 1e-9;

}  // namespace

// The spheres that a block's points are deepest in.
struct ExcludedField::Block {
    std::array<Deepest, points_of_block> deepest{};
    std::array<Vec3, points_of_block> places;
};

double ExcludedField::reach(double radius) const noexcept { return radius + 2 * probe_ + spacing_; }

void ExcludedField::move(const BallGrid& grid, std::span<const MovedBall> moved) {
    grid_ = &grid;
    for (const MovedBall& ball : moved) {
        const std::size_t needed = std::size_t{ball.atom} + 1;
        if (arcs_.size() < needed) {
            arcs_.resize(needed);
            has_arcs_.resize(needed, false);
        }
        has_arcs_[ball.atom] = false;
        // Arcs on spheres that the moved one meets, or did. Radii of balls that are gone are not
        // known here; none is larger than all that ever were.
        largest_radius_ = std::max(largest_radius_, grid.largest_radius());
        const double touch = 2 * (largest_radius_ + probe_);
        for (const Vec3& place : {ball.from, ball.to}) {
            if (!place.allFinite()) continue;
            grid.visit_near(place, touch, [&](const AtomBall& other, double /*squared*/) {
                if (other.atom < has_arcs_.size()) has_arcs_[other.atom] = false;
            });
        }
    }
}

bool ExcludedField::is_accessible(const Vec3& place, std::uint32_t atom) const {
    return !grid_->any_near(place, grid_->largest_radius() + probe_,
                            [&](const AtomBall& ball, double squared) {
                                const double r = ball.radius + probe_ - margin;
                                return ball.atom != atom && squared < r * r;
                            });
}

const std::vector<AccessibleArc>& ExcludedField::arcs_of(const AtomBall& ball) {
    std::vector<AccessibleArc>& arcs = arcs_[ball.atom];
    if (has_arcs_[ball.atom]) return arcs;
    arcs.clear();
    std::vector<AtomBall> near;
    const double touch = ball.radius + grid_->largest_radius() + 2 * probe_;
    grid_->visit_near(ball.centre, touch, [&](const AtomBall& other, double /*squared*/) {
        near.push_back({other.centre, other.radius + probe_, other.atom});
    });
    find_accessible_arcs({ball.centre, ball.radius + probe_, ball.atom}, near, arcs);
    has_arcs_[ball.atom] = true;
    return arcs;
}

ExcludedField::Deepest ExcludedField::find_deepest(const Vec3& place) const {
    Deepest deepest{-2 * spacing_, {}};
    const double far = grid_->largest_radius() + probe_ + 2 * spacing_;
    grid_->visit_near(place, far, [&](const AtomBall& ball, double squared) {
        const double depth = ball.radius + probe_ - std::sqrt(squared);
        if (depth > deepest.depth) deepest = {depth, ball};
    });
    return deepest;
}

// Where the probe's centre is nearest to a place inside of the spheres, and how far that is. No
// farther than a spacing from the surface; the distance is then that, and `free` untouched.
double ExcludedField::find_free(const Vec3& place, const Deepest& deepest, Vec3& free) {
    double distance = probe_ + spacing_;
    if (deepest.depth >= distance) return distance;
    const AtomBall& ball = deepest.ball;
    const Vec3 out = place - ball.centre;
    const double length = out.norm();
    const Vec3 direction = length > 0 ? Vec3(out / length) : Vec3::UnitZ();
    const Vec3 above = ball.centre + (ball.radius + probe_) * direction;
    if (is_accessible(above, ball.atom)) {
        free = above;
        return deepest.depth;
    }
    const double far = grid_->largest_radius() + probe_ + distance;
    grid_->visit_near(place, far, [&](const AtomBall& near, double squared) {
        const std::vector<AccessibleArc>& arcs = arcs_of(near);
        if (arcs.empty()) return;
        if (std::abs(std::sqrt(squared) - near.radius - probe_) >= distance) return;
        for (const AccessibleArc& arc : arcs) find_nearest_on_arc(arc, place, distance, free);
    });
    return distance;
}

bool ExcludedField::sample(const BlockIndex& block, BlockSamples& samples) {
    const Vec3 low = block_corner(block, spacing_);
    const Vec3 high = low + Vec3::Constant(block_cells * spacing_);
    const Vec3 far = Vec3::Constant(reach(grid_->largest_radius()));
    Block found;
    for (int z = 0; z < block_points; ++z)
        for (int y = 0; y < block_points; ++y)
            for (int x = 0; x < block_points; ++x)
                found.places[point_index(x, y, z)] = {point_coordinate(block[0], x, spacing_),
                                                      point_coordinate(block[1], y, spacing_),
                                                      point_coordinate(block[2], z, spacing_)};
    found.deepest.fill({-spacing_, {}});
    bool has_any = false;
    grid_->visit_box(low - far, high + far, [&](const AtomBall& ball) {
        has_any = true;
        const double edge = ball.radius + probe_;
        std::array<int, 3> first{}, last{};
        for (int k = 0; k < 3; ++k) {
            const double start = (ball.centre[k] - edge - low[k]) / spacing_ - 1;
            const double end = (ball.centre[k] + edge - low[k]) / spacing_ + 1;
            first[static_cast<std::size_t>(k)] = std::max(0, static_cast<int>(std::floor(start)));
            last[static_cast<std::size_t>(k)] =
                std::min(block_cells, static_cast<int>(std::ceil(end)));
        }
        for (int z = first[2]; z <= last[2]; ++z)
            for (int y = first[1]; y <= last[1]; ++y)
                for (int x = first[0]; x <= last[0]; ++x) {
                    const std::size_t i = point_index(x, y, z);
                    const double depth = edge - (found.places[i] - ball.centre).norm();
                    if (depth > found.deepest[i].depth) found.deepest[i] = {depth, ball};
                }
    });
    if (!has_any) return false;
    set_values(found, samples);
    return true;
}

// Inside of an atom's own sphere the sign is clear, and the value of use only beside a place that
// is outside.
void ExcludedField::set_values(const Block& found, BlockSamples& samples) {
    const auto exact = [&](std::size_t i) {
        Vec3 free;
        return static_cast<float>(find_free(found.places[i], found.deepest[i], free) - probe_);
    };
    for (std::size_t i = 0; i < points_of_block; ++i) {
        const double depth = found.deepest[i].depth;
        if (depth > probe_) {
            samples[i] = static_cast<float>(spacing_);
        } else {
            samples[i] = depth <= 0 ? static_cast<float>(depth - probe_) : exact(i);
        }
    }
    const auto has_outside = [&](int x, int y, int z) {
        return (x > 0 && samples[point_index(x - 1, y, z)] <= 0) ||
               (x < block_cells && samples[point_index(x + 1, y, z)] <= 0) ||
               (y > 0 && samples[point_index(x, y - 1, z)] <= 0) ||
               (y < block_cells && samples[point_index(x, y + 1, z)] <= 0) ||
               (z > 0 && samples[point_index(x, y, z - 1)] <= 0) ||
               (z < block_cells && samples[point_index(x, y, z + 1)] <= 0);
    };
    for (int z = 0; z < block_points; ++z)
        for (int y = 0; y < block_points; ++y)
            for (int x = 0; x < block_points; ++x) {
                const std::size_t i = point_index(x, y, z);
                if (found.deepest[i].depth > probe_ && has_outside(x, y, z))
                    samples[i] = std::max(exact(i), 1e-6F);
            }
}

SurfacePoint ExcludedField::refine(const Vec3& near) {
    const Deepest deepest = find_deepest(near);
    const AtomBall& ball = deepest.ball;
    const Vec3 out = near - ball.centre;
    const double length = out.norm();
    SurfacePoint point{near, length > 0 ? Vec3(out / length) : Vec3::UnitZ(), ball.atom};
    if (deepest.depth <= 0) {
        point.place = ball.centre + ball.radius * point.normal;
        return point;
    }
    Vec3 free;
    const double distance = find_free(near, deepest, free);
    if (distance >= probe_ + spacing_) return point;
    if (distance > margin) point.normal = (free - near) / distance;
    point.place = free - probe_ * point.normal;
    return point;
}

}  // namespace palpa
