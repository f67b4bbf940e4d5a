// The light that casts shadows: a lamp ten radii of the scene away, so that its rays are parallel
// but for six degrees, and a camera there, for which shapes are drawn as for the picture's camera.
// From farther away the squares of distances would lose atoms' radii in single precision.
#pragma once
#include "render/frame_scene.h"
#include "render/gpu_frame.h"

#include <glm/mat4x4.hpp>

namespace palpa {

// The sun around all opaque objects that are not on top.
Sun find_sun(const FrameScene& scene, const glm::mat4& view);

// Transforms view space to the sun's space, as in light.glsl.
glm::mat4 sun_matrix(const Sun& sun);

// The sun's frame of the same scene.
GpuFrame build_sun_frame(const GpuFrame& frame);

}  // namespace palpa
