#include "render/sun.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace palpa {
namespace {

constexpr std::int32_t sun_pixels = 2048;
constexpr float radii_away = 10;

class Box {
public:
    void add(const glm::vec3& centre, float radius) {
        low_ = glm::min(low_, centre - radius);
        high_ = glm::max(high_, centre + radius);
    }
    glm::vec3 centre() const { return is_empty() ? glm::vec3(0) : 0.5F * (low_ + high_); }
    float radius() const {
        return is_empty() ? 1 : std::max(0.5F * glm::length(high_ - low_), 1e-3F);
    }

private:
    bool is_empty() const { return low_.x > high_.x; }

    glm::vec3 low_{std::numeric_limits<float>::max()}, high_{std::numeric_limits<float>::lowest()};
};

}  // namespace

Sun find_sun(const FrameScene& scene, const glm::mat4& view) {
    Box box;
    for (const SphereShape& sphere : scene.spheres) {
        if (!sphere.is_on_top) box.add(sphere.centre, sphere.radius);
    }
    for (const ConeShape& cone : scene.cones) {
        if (cone.is_on_top) continue;
        box.add(cone.a, cone.radius_a);
        box.add(cone.b, cone.radius_b);
    }
    for (const MeshShape& mesh : scene.meshes) {
        if (mesh.opacity < 1) continue;
        for (const MeshVertex& vertex : mesh.vertices) box.add(vertex.place, 0);
    }
    // A sphere of radius 1 at a distance d is seen under the angle whose sine is 1 / d.
    return {glm::vec3(view * glm::vec4(box.centre(), 1)), radii_away * box.radius(),
            std::sqrt(radii_away * radii_away - 1), sun_pixels};
}

glm::mat4 sun_matrix(const Sun& sun) {
    const glm::vec3 light(-0.4F, 0.6F, 0.7F);
    return glm::lookAt(sun.centre + sun.distance * glm::normalize(light), sun.centre, {0, 1, 0});
}

GpuFrame build_sun_frame(const GpuFrame& frame) {
    const Sun& sun = frame.sun;
    const float radius = 1.001F * sun.distance / radii_away;
    const auto size = static_cast<float>(sun.size);
    GpuFrame from_sun = frame;
    from_sun.projection = {sun.scale, sun.scale, sun.distance - radius, sun.distance + radius};
    from_sun.size = {size, size, 1 / size, 1 / size};
    from_sun.centre = {0, 0};
    from_sun.origin = {0, 0};
    return from_sun;
}

}  // namespace palpa
