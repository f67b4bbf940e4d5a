// The content of one picture as plain shapes. Lengths in Å, colours in linear RGB from 0 to 1.
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace palpa {

// `pick` names what a shape stands for; whoever asks which thing is at a pixel gets it back. What
// is on top is hidden by nothing that is not.
struct SphereShape {
    glm::vec3 centre{0};
    float radius = 1;
    glm::vec3 colour{1};
    std::uint32_t pick = 0;
    bool is_on_top = false;
};

// A cylinder, or a cone where the radii differ; coloured in two halves. Flat at `a`, open at `b`.
struct ConeShape {
    glm::vec3 a{0}, b{0};
    float radius_a = 1, radius_b = 1;
    glm::vec3 colour_a{1}, colour_b{1};
    std::uint32_t pick = 0;
    bool is_on_top = false;
};

// A closed or open surface of triangles, seen from both sides.
struct MeshVertex {
    glm::vec3 place{0};
    glm::vec3 normal{0, 0, 1};  // unit vector, outward
    glm::vec3 colour{1};
    std::uint32_t pick = 0;
};
struct MeshShape {
    std::vector<MeshVertex> vertices{};
    // Three to a triangle, counter-clockwise as seen from outside; a triangle is picked as its
    // first.
    std::vector<std::uint32_t> indices{};
    // Below 1 what lies behind shines through; of more than 32 layers at one pixel the nearest 32
    // are drawn. Seen aslant a surface covers more, as glass of one thickness does:
    // 1 - (1 - opacity)^(1 / cosine), the cosine 0.25 at least. What is translucent has no outline,
    // darkens no crevice, casts no shadow, and is picked only where nothing opaque is.
    float opacity = 1;
    // No way in from outside: what faces away is hidden, and need not be drawn.
    bool is_closed = false;
};

struct FrameCamera {
    glm::vec3 eye{0, 0, 10}, target{0}, up{0, 1, 0};
    float vertical_angle = 0.6F;  // rad
    float near = 0.1F, far = 1000;
    glm::vec2 centre{0};  // where the target is seen: to the right and up, in halves of the picture
    // What is farther away than `fog_from` fades into the background, slowly at first: by a factor
    // of e where it is `fog_length` farther, never wholly. 0: nothing does.
    float fog_from = 0, fog_length = 0;
};

struct FrameScene {
    std::vector<SphereShape> spheres{};
    std::vector<ConeShape> cones{};
    std::vector<MeshShape> meshes{};
    FrameCamera camera{};
    glm::vec3 background{1};
    // Instead of it alpha is 0 where nothing is, and less than 1 where only translucent things are.
    // Fog still fades into the colour.
    bool clear_background = false;
    int outline = 1;        // width in pixels
    bool occlusion = true;  // darker crevices; costs drawing time
    bool is_fine = false;   // smoother occlusion, for pictures without a time limit
    // Thins out very many shapes smaller than a pixel (render/drawn_shapes.h).
    bool is_coarse = false;
    bool shadows = false;  // shadows of opaque objects; everything is drawn once more
};

}  // namespace palpa
