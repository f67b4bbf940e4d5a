// Converts positions of the world to those of pictures.
#pragma once
#include "math/vec.h"

#include <glm/vec3.hpp>

namespace palpa {

inline glm::vec3 as_float(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace palpa
