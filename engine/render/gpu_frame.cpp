#include "render/gpu_frame.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpa {
namespace {

constexpr std::int32_t fine_spirals = 6;  // of taps of ambient occlusion

template <class Shapes>
std::uint32_t count_below(const Shapes& shapes) {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(shapes, [](const auto& shape) { return !shape.is_on_top; }));
}

}  // namespace

GpuFrame build_frame_constants(const FrameScene& scene, VkExtent2D size) {
    const FrameCamera& camera = scene.camera;
    const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
    const float y_scale = 1 / std::tan(camera.vertical_angle / 2);
    const GpuFrame frame{{y_scale * height / width, y_scale, camera.near, camera.far},
                         {width, height, 1 / width, 1 / height},
                         {scene.background, camera.fog_length > 0 ? 1 / camera.fog_length : 0},
                         0,
                         scene.outline,
                         scene.occlusion ? (scene.is_fine ? fine_spirals : 1) : 0,
                         camera.fog_from,
                         camera.centre,
                         0,
                         0,
                         0,
                         0,
                         {0, 0},
                         {}};
    return count_shapes(frame, scene.spheres, scene.cones);
}

GpuFrame count_shapes(GpuFrame frame, const std::vector<SphereShape>& spheres,
                      const std::vector<ConeShape>& cones) {
    frame.spheres = static_cast<std::uint32_t>(spheres.size());
    frame.shapes = static_cast<std::uint32_t>(spheres.size() + cones.size());
    frame.last_sphere_below = count_below(spheres);
    frame.last_cone_below = frame.spheres + count_below(cones);
    return frame;
}

VkExtent2D size_of(const GpuFrame& frame) {
    return {static_cast<std::uint32_t>(frame.size.x), static_cast<std::uint32_t>(frame.size.y)};
}

GpuFrame crop_frame(const GpuFrame& whole, const VkRect2D& part) {
    const glm::vec2 from(part.offset.x, part.offset.y), size(part.extent.width, part.extent.height),
        whole_size(whole.size), zoom = whole_size / size;
    // Where the camera's axis is seen, in pixels from the upper left.
    const glm::vec2 axis = 0.5F * whole_size * glm::vec2(1 + whole.centre.x, 1 - whole.centre.y);
    const glm::vec2 centre = 2.0F * (axis - from) / size - 1.0F;
    GpuFrame frame = whole;
    frame.projection.x *= zoom.x;
    frame.projection.y *= zoom.y;
    frame.size = {size, 1.0F / size};
    frame.centre = {centre.x, -centre.y};
    frame.origin = {part.offset.x, part.offset.y};
    return frame;
}

GpuShape build_shape(const glm::mat4& view, const SphereShape& sphere) {
    const glm::vec3 centre(view * glm::vec4(sphere.centre, 1));
    return {{centre, sphere.radius}, {0, 0, 0, 0}, {sphere.colour, 0}, {sphere.colour, 0}};
}

GpuShape build_shape(const glm::mat4& view, const ConeShape& cone) {
    const glm::vec3 a(view * glm::vec4(cone.a, 1)), b(view * glm::vec4(cone.b, 1));
    const float height = std::max(glm::length(b - a), 1e-6F);  // both ends at one place: nothing
    return {{a, cone.radius_a},
            {(b - a) / height, height},
            {cone.colour_a, (cone.radius_b - cone.radius_a) / height},
            {cone.colour_b, 0}};
}

}  // namespace palpa
