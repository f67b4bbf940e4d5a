// The frame data for shaders: the layouts of shaders/frame.glsl, and image formats.
#pragma once
#include "render/frame_scene.h"

#include <vulkan/vulkan.h>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace palpa {

inline constexpr VkFormat seen_format = VK_FORMAT_R32G32_UINT, depth_format = VK_FORMAT_D32_SFLOAT,
                          colour_format = VK_FORMAT_R8G8B8A8_UNORM,
                          drawn_format = VK_FORMAT_R8G8B8A8_SRGB;

// The visible object at a pixel.
struct Seen {
    std::uint32_t id;  // number of the shape or triangle from 1; 0: nothing
    float distance;    // distance from the camera
};
inline constexpr float nowhere =
    1e9F;  // the distance of nothing, for shaders: a number that they can reckon with

struct GpuShape {
    glm::vec4 start, axis, paint_a, paint_b;
};

struct GpuVertex {
    glm::vec3 place;       // in view space
    std::uint32_t normal;  // on an octahedron, its two coordinates in 16 bits each
    std::uint32_t paint;   // square roots of the colour, and the opacity, in 8 bits each
};

// Where the light of shadows comes from: a camera far away, whose picture has everything. In view
// space.
struct Sun {
    glm::vec3 centre;   // centre of its view
    float distance;     // distance from the centre
    float scale;        // scale of its projection
    std::int32_t size;  // size of its picture, pixels each way
};

struct GpuFrame {
    glm::vec4 projection, size, fog;
    std::uint32_t spheres;
    std::int32_t outline, spirals;
    float fog_from;
    glm::vec2 centre;
    std::uint32_t last_sphere_below, last_cone_below;
    std::uint32_t shapes, layer_room;
    glm::ivec2 origin;
    Sun sun;  // used with shadows
};
static_assert(sizeof(GpuFrame) <= 128, "push constants");

// Shapes are numbered from 1: spheres, then cones, those on top last of their kind; then triangles.
GpuFrame build_frame_constants(const FrameScene& scene, VkExtent2D size);

// The same with the numbers of these shapes.
GpuFrame count_shapes(GpuFrame frame, const std::vector<SphereShape>& spheres,
                      const std::vector<ConeShape>& cones);

VkExtent2D size_of(const GpuFrame& frame);

// The same for a part of that picture, drawn by itself.
GpuFrame crop_frame(const GpuFrame& whole, const VkRect2D& part);

GpuShape build_shape(const glm::mat4& view, const SphereShape& sphere);
GpuShape build_shape(const glm::mat4& view, const ConeShape& cone);

}  // namespace palpa
