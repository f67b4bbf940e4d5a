#include "render/drawn_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace palpa {
namespace {

constexpr std::size_t many_small = 100'000;           // shapes
constexpr float small_sphere = 1, small_cone = 0.5F;  // pixels of a radius

}  // namespace

DrawnShapes::Bound DrawnShapes::bound_of(const glm::vec3& centre, float radius,
                                         float thickness) const {
    Bound bound{0, 0, -centre.z, radius, 0, thickness, false, true};
    const float nearest = bound.distance - radius;
    if (bound.distance + radius < frame_.projection.z) return bound;
    const float middle = std::max(bound.distance, frame_.projection.z);
    const float x_scale = 0.5F * frame_.size.x * frame_.projection.x,
                y_scale = 0.5F * frame_.size.y * frame_.projection.y;
    bound.x = 0.5F * frame_.size.x * (1 + frame_.centre.x) + x_scale * centre.x / middle;
    bound.y = 0.5F * frame_.size.y * (1 - frame_.centre.y) - y_scale * centre.y / middle;
    if (nearest < frame_.projection.z) {  // around the camera
        bound.reach = std::numeric_limits<float>::max();
        bound.is_drawn = true;
        return bound;
    }
    // The largest change of x / z or y / z within the ball.
    const float aslant = std::max(std::abs(centre.x), std::abs(centre.y)) / bound.distance;
    bound.reach =
        1 + std::max(x_scale, y_scale) * radius * std::sqrt(1 + aslant * aslant) / nearest;
    bound.is_drawn = bound.x + bound.reach > 0 && bound.x - bound.reach < frame_.size.x &&
                     bound.y + bound.reach > 0 && bound.y - bound.reach < frame_.size.y;
    return bound;
}

// A ray that passes a sphere's centre within 0.6 of its radius meets the sphere in front of the
// centre, if it is within 53° of the camera's axis. Those of a disc of pixels do.
void DrawnShapes::cover(const Bound& sphere) {
    constexpr float inner = 0.6F, farthest_aside = 0.9F;  // tangent of an angle, of each axis
    const float x_end = (1 + std::abs(frame_.centre.x)) / frame_.projection.x,
                y_end = (1 + std::abs(frame_.centre.y)) / frame_.projection.y;
    if (sphere.distance - sphere.radius < frame_.projection.z || x_end > farthest_aside ||
        y_end > farthest_aside)
        return;
    const float scale = 0.5F * frame_.size.y * frame_.projection.y / sphere.distance,
                reach = inner * sphere.radius * scale;
    // Of pixels whose middles are between two places.
    const auto first = [](float at) {
        return std::max(static_cast<std::int32_t>(std::ceil(at - 0.5F)), 0);
    };
    const auto end = [](float at, std::int32_t size) {
        return std::min(static_cast<std::int32_t>(std::floor(at - 0.5F)) + 1, size);
    };
    const std::int32_t bottom = end(sphere.y + reach, height_);
    for (std::int32_t y = first(sphere.y - reach); y < bottom; ++y) {
        const float down = static_cast<float>(y) + 0.5F - sphere.y,
                    half = std::sqrt(std::max(reach * reach - down * down, 0.0F));
        const std::int32_t right = end(sphere.x + half, width_);
        float* const row = covered_.data() + std::ptrdiff_t{y} * width_;
        for (std::int32_t x = first(sphere.x - half); x < right; ++x)
            row[x] = std::min(row[x], sphere.distance);
    }
}

bool DrawnShapes::is_covered(const Bound& bound) const {
    constexpr float margin = 0.01F;  // Å
    const float nearest = bound.distance - bound.radius - margin;
    if (nearest < frame_.projection.z) return false;
    const auto limit = [](float at, std::int32_t size) {
        return std::clamp(static_cast<std::int32_t>(std::floor(at)), 0, size);
    };
    const std::int32_t left = limit(bound.x - bound.reach, width_ - 1),
                       right = limit(bound.x + bound.reach, width_ - 1),
                       bottom = limit(bound.y + bound.reach, height_ - 1);
    for (std::int32_t y = limit(bound.y - bound.reach, height_ - 1); y <= bottom; ++y) {
        const float* const row = covered_.data() + std::ptrdiff_t{y} * width_;
        for (std::int32_t x = left; x <= right; ++x)
            if (!(row[x] < nearest)) return false;
    }
    return true;
}

bool DrawnShapes::is_small(const Bound& bound, float pixels) const {
    const float scale = 0.5F * frame_.size.y * frame_.projection.y;
    return bound.is_free && bound.is_drawn && scale * bound.thickness < pixels * bound.distance;
}

std::size_t DrawnShapes::count_small(const std::vector<Bound>& bounds, float pixels) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(bounds, [&](const Bound& bound) { return is_small(bound, pixels); }));
}

void DrawnShapes::thin_out(std::vector<Bound>& bounds, float pixels) {
    const std::int32_t columns = width_ / 2 + 1;
    const auto cell_of = [&](const Bound& bound) {
        const auto x = static_cast<std::int32_t>(std::clamp(bound.x, 0.0F, frame_.size.x)) / 2,
                   y = static_cast<std::int32_t>(std::clamp(bound.y, 0.0F, frame_.size.y)) / 2;
        return static_cast<std::size_t>(y * columns + x);
    };
    nearest_.assign(static_cast<std::size_t>(columns * (height_ / 2 + 1)), 0);
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        if (!is_small(bounds[i], pixels)) continue;
        std::uint32_t& nearest = nearest_[cell_of(bounds[i])];
        if (nearest == 0 || bounds[i].distance < bounds[nearest - 1].distance)
            nearest = static_cast<std::uint32_t>(i + 1);
    }
    const float scale = 0.5F * frame_.size.y * frame_.projection.y;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        Bound& bound = bounds[i];
        if (!is_small(bound, pixels)) continue;
        bound.is_drawn = nearest_[cell_of(bound)] == i + 1;
        bound.thickness = pixels * bound.distance / scale;
    }
}

void DrawnShapes::find_bounds(const FrameScene& scene, const glm::mat4& view) {
    const glm::mat3 turn(view);
    const glm::vec3 shift(view[3]);
    sphere_bounds_.clear();
    for (const SphereShape& sphere : scene.spheres) {
        sphere_bounds_.push_back(
            bound_of(turn * sphere.centre + shift, sphere.radius, sphere.radius));
        sphere_bounds_.back().is_free = !sphere.is_on_top;
    }
    cone_bounds_.clear();
    for (const ConeShape& cone : scene.cones) {
        const float thickness = std::max(cone.radius_a, cone.radius_b);
        cone_bounds_.push_back(bound_of(turn * (0.5F * (cone.a + cone.b)) + shift,
                                        0.5F * glm::length(cone.b - cone.a) + thickness,
                                        thickness));
        cone_bounds_.back().is_free = !cone.is_on_top;
    }
}

void DrawnShapes::choose(const FrameScene& scene, const glm::mat4& view, const GpuFrame& frame) {
    frame_ = frame;
    width_ = static_cast<std::int32_t>(frame.size.x);
    height_ = static_cast<std::int32_t>(frame.size.y);
    find_bounds(scene, view);
    if (scene.is_coarse &&
        count_small(sphere_bounds_, small_sphere) + count_small(cone_bounds_, small_cone) >
            many_small) {
        thin_out(sphere_bounds_, small_sphere);
        thin_out(cone_bounds_, small_cone);
    }
    covered_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                    std::numeric_limits<float>::max());
    for (const Bound& bound : sphere_bounds_)
        if (bound.is_free && bound.is_drawn) cover(bound);
    const auto is_drawn = [&](const Bound& bound) {
        return !bound.is_free || (bound.is_drawn && !is_covered(bound));
    };
    spheres_.clear();
    for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
        if (!is_drawn(sphere_bounds_[i])) continue;
        spheres_.push_back(scene.spheres[i]);
        spheres_.back().radius = sphere_bounds_[i].thickness;
    }
    cones_.clear();
    for (std::size_t i = 0; i < scene.cones.size(); ++i) {
        if (!is_drawn(cone_bounds_[i])) continue;
        ConeShape& cone = cones_.emplace_back(scene.cones[i]);
        const float thickness = std::max(cone.radius_a, cone.radius_b);
        if (cone_bounds_[i].thickness > thickness) {
            cone.radius_a *= cone_bounds_[i].thickness / thickness;
            cone.radius_b *= cone_bounds_[i].thickness / thickness;
        }
    }
}

}  // namespace palpa
