// Where something new has room among atoms, near what a person looks at.
#pragma once
#include "math/vec.h"
#include "view/orbit_camera.h"

#include <glm/vec3.hpp>
#include <optional>
#include <span>

namespace palpa {

// What is to be added: atoms counted from its reference atom, and how far from `taken` each stays.
// Of something whose shape is not known: one atom, farther from the rest.
struct Newcomer {
    std::span<const Vec3> atoms;  // Å
    double gap = 3;               // Å
};

// The place for its reference atom that is nearest to the camera's target, turned as it is. Tried
// are the places of a grid along the picture's axes: 1 Å apart within 16 Å of the target, twice as
// far apart in each further shell, which is twice as thick. Of places equally near the one that is
// least in front or behind, then the upper one, then the one at the right. Nothing where none is
// within 10000 Å of the origin.
std::optional<Vec3> find_room(std::span<const glm::vec3> taken, const Newcomer& newcomer,
                              const OrbitCamera& camera);

}  // namespace palpa
