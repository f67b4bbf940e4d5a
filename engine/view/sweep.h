// Closed triangle meshes: a cross section swept along a path, and flat plates.
#pragma once
#include "render/frame_scene.h"
#include "view/ribbon_path.h"

#include <array>
#include <cstdint>
#include <span>

namespace palpa {

// A cross section of a body.
struct Ring {
    RibbonFrame frame;
    float half_width = 0.3F, half_thickness = 0.3F;  // Å, along `aside` and along the normal
    glm::vec3 colour{1};
    std::uint32_t pick = 0;
};

enum class CrossSection {
    Oval,  // an ellipse, smooth all around
    Box,   // a rectangle with four sharp edges
};

// Adds the body through two or more rings, with flat ends. An oval has `sides` sides, at least
// three. Smooth along the path.
void add_sweep(std::span<const Ring> rings, CrossSection section, int sides, MeshShape& mesh);

// Colour and pick of a face.
struct Look {
    glm::vec3 colour{1};
    std::uint32_t pick = 0;
};

// Adds a plate in the plane of a convex outline of at least three points in order. Returns false
// and adds nothing for collinear points.
bool add_plate(std::span<const glm::vec3> outline, float half_thickness, const Look& look,
               MeshShape& mesh);

}  // namespace palpa
