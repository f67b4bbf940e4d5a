// The pixels of a test's picture: where a place is seen, how many show a thing, what light they
// are.
#pragma once
#include "render/picture.h"
#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>

namespace palpa::test {

inline constexpr std::uint32_t width = 320, height = 240;

inline std::size_t pixel_of(const FrameCamera& camera, const glm::vec3& point) {
    const glm::vec3 there = project(camera, point, width, height);
    return static_cast<std::size_t>(there.y) * width + static_cast<std::size_t>(there.x);
}

inline std::size_t count(const Picture& picture, std::uint32_t pick) {
    return static_cast<std::size_t>(std::ranges::count(picture.picks, pick));
}

// sRGB (IEC 61966-2-1), from 0 to 1.
inline double encoded(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}
inline double decoded(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

}  // namespace palpa::test
