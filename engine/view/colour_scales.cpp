#include "view/colour_scales.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <span>

namespace palpa {
namespace {

constexpr glm::vec3 grey{0.3F, 0.3F, 0.3F};

// From 8 bits a channel of sRGB (IEC 61966-2-1).
glm::vec3 from_srgb(int red, int green, int blue) {
    const auto linear = [](int byte) {
        const float v = static_cast<float>(byte) / 255;
        return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
    };
    return {linear(red), linear(green), linear(blue)};
}

// Between the points that are evenly spread from 0 to 1, in the eye's steps: roots of light.
glm::vec3 between(std::span<const glm::vec3> points, double share) {
    const double along = std::clamp(share, 0.0, 1.0) * static_cast<double>(points.size() - 1);
    const auto first = std::min(static_cast<std::size_t>(along), points.size() - 2);
    const auto part = static_cast<float>(along - static_cast<double>(first));
    const glm::vec3 root = glm::mix(glm::sqrt(points[first]), glm::sqrt(points[first + 1]), part);
    return root * root;
}

}  // namespace

glm::vec3 diverging_colour(double value, double end) {
    static const std::array points{from_srgb(190, 20, 30), from_srgb(244, 165, 130),
                                   from_srgb(247, 247, 247), from_srgb(125, 170, 235),
                                   from_srgb(20, 60, 185)};
    if (!std::isfinite(value) || !(end > 0)) return grey;
    return between(points, 0.5 + value / (2 * end));
}

glm::vec3 hydropathy_colour(std::optional<double> hydropathy) {
    static const std::array points{from_srgb(15, 120, 135), from_srgb(240, 240, 235),
                                   from_srgb(205, 135, 20)};
    constexpr double end = 4.5;
    if (!hydropathy) return grey;
    return between(points, 0.5 + *hydropathy / (2 * end));
}

glm::vec3 sequential_colour(double share) {
    static const std::array points{
        from_srgb(68, 1, 84),    from_srgb(71, 45, 123),  from_srgb(59, 82, 139),
        from_srgb(44, 114, 142), from_srgb(33, 144, 140), from_srgb(39, 173, 129),
        from_srgb(93, 200, 99),  from_srgb(170, 220, 50), from_srgb(253, 231, 37)};
    return std::isfinite(share) ? between(points, share) : grey;
}

glm::vec3 categorical_colour(std::size_t index) {
    static const std::array colours{from_srgb(0, 0, 0),      from_srgb(230, 159, 0),
                                    from_srgb(86, 180, 233), from_srgb(0, 158, 115),
                                    from_srgb(240, 228, 66), from_srgb(0, 114, 178),
                                    from_srgb(213, 94, 0),   from_srgb(204, 121, 167)};
    return colours[index % colours.size()];
}

}  // namespace palpa
