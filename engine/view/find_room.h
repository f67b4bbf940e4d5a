// Finds free space for a new molecule near the centre of view.
#pragma once
#include "math/vec.h"
#include "view/orbit_camera.h"

#include <glm/vec3.hpp>
#include <optional>
#include <span>

namespace palpa {

// The new molecule: positions of its atoms relative to its reference atom, and the gap to atoms in
// `taken`. If its shape is unknown: one atom with a larger gap.
struct Newcomer {
    std::span<const Vec3> atoms;  // Å
    double gap = 3;               // Å
};

// The position for its reference atom that is nearest to the camera's target, in its given
// orientation. Candidates are grid points along the picture's axes: 1 Å apart within 16 Å of the
// target, then twice the spacing in each further shell, which is twice as thick. Among equally near
// points the one least in front or behind wins, then the upper one, then the one to the right.
// Nothing if no point within 10000 Å of the origin is free.
std::optional<Vec3> find_room(std::span<const glm::vec3> taken, const Newcomer& newcomer,
                              const OrbitCamera& camera);

}  // namespace palpa
