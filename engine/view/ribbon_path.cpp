#include "view/ribbon_path.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

namespace palpa {
namespace {

constexpr float no_length = 1e-6F;

// Some direction at right angles to a unit vector.
glm::vec3 any_aside(const glm::vec3& along) {
    const glm::vec3 other = std::abs(along.x) < 0.8F ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::normalize(glm::cross(along, other));
}

glm::vec3 at_right_angles(const glm::vec3& v, const glm::vec3& along) {
    return v - glm::dot(v, along) * along;
}

// Second derivatives of the natural spline: m[i-1] + 4 m[i] + m[i+1] = 6 (p[i-1] - 2 p[i] +
// p[i+1]), zero at both ends.
std::vector<glm::vec3> find_bends(std::span<const glm::vec3> places) {
    std::vector<glm::vec3> bends(places.size(), glm::vec3(0));
    std::vector<float> share(places.size(), 0.0F);
    for (std::size_t i = 1; i + 1 < places.size(); ++i) {
        share[i] = 1 / (4 - share[i - 1]);
        bends[i] =
            share[i] * (6.0F * (places[i - 1] - 2.0F * places[i] + places[i + 1]) - bends[i - 1]);
    }
    for (std::size_t i = places.size() - 1; i-- > 1;) bends[i] -= share[i] * bends[i + 1];
    return bends;
}

}  // namespace

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) noexcept {
    const float square = glm::dot(v, v);
    return square > no_length * no_length ? v / std::sqrt(square) : otherwise;
}

glm::vec3 RibbonFrame::up() const noexcept { return glm::cross(along, aside); }

RibbonPath::RibbonPath(std::vector<glm::vec3> guides)
    : guides_(std::move(guides)), bends_(find_bends(guides_)) {}

RibbonPath::Piece RibbonPath::piece_of(float u) const noexcept {
    const float guide = std::clamp(std::floor(u), 0.0F, static_cast<float>(size() - 2));
    return {static_cast<std::size_t>(guide), std::clamp(u - guide, 0.0F, 1.0F)};
}

glm::vec3 RibbonPath::place(float u) const noexcept {
    const auto [i, t] = piece_of(u);
    const float s = 1 - t;
    return s * guides_[i] + t * guides_[i + 1] +
           ((s * s * s - s) * bends_[i] + (t * t * t - t) * bends_[i + 1]) / 6.0F;
}

glm::vec3 RibbonPath::slope(float u) const noexcept {
    const auto [i, t] = piece_of(u);
    const float s = 1 - t;
    return guides_[i + 1] - guides_[i] +
           ((1 - 3 * s * s) * bends_[i] + (3 * t * t - 1) * bends_[i + 1]) / 6.0F;
}

glm::vec3 RibbonPath::along(float u) const noexcept {
    // Where the curve stands still, as at coincident guides, the way from end to end is taken.
    return unit_or(slope(u), unit_or(guides_.back() - guides_.front(), {0, 0, 1}));
}

glm::vec3 RibbonPath::carry_aside(const glm::vec3& aside, std::size_t to) const noexcept {
    const glm::vec3 direction = along(static_cast<float>(to));
    return unit_or(at_right_angles(aside, direction), any_aside(direction));
}

void RibbonPath::turn(std::span<const glm::vec3> aside) {
    asides_.assign(aside.begin(), aside.end());
    const auto is_known = [&](std::size_t i) { return asides_[i] != glm::vec3(0); };
    std::size_t known = 0;
    while (known < size() && !is_known(known)) ++known;
    if (known == size()) asides_[known = 0] = any_aside(along(0));
    asides_[known] = carry_aside(asides_[known], known);
    for (std::size_t i = known; i-- > 0;) asides_[i] = carry_aside(asides_[i + 1], i);

    std::size_t last = known;  // the last that was known
    for (std::size_t i = known + 1; i < size(); ++i) {
        const glm::vec3 carried = carry_aside(asides_[i - 1], i);
        if (!is_known(i)) {
            asides_[i] = carried;
            continue;
        }
        asides_[i] = carry_aside(asides_[i], i);
        if (glm::dot(asides_[i], carried) < 0) asides_[i] = -asides_[i];
        turn_gap(last, i);
        last = i;
    }
}

// The remaining twist is spread evenly over the guides between.
void RibbonPath::turn_gap(std::size_t before, std::size_t behind) {
    glm::vec3 carried = asides_[behind];
    for (std::size_t i = behind - 1; i > before; --i) {
        carried = carry_aside(carried, i);
        const float share = static_cast<float>(i - before) / static_cast<float>(behind - before);
        asides_[i] = carry_aside(glm::mix(asides_[i], carried, share), i);
    }
}

RibbonFrame RibbonPath::frame(float u) const noexcept {
    const auto [i, t] = piece_of(u);
    const auto at = [&](std::size_t k) { return asides_[std::min(k, size() - 1)]; };
    const glm::vec3 before = at(i == 0 ? 0 : i - 1), a = at(i), b = at(i + 1), behind = at(i + 2);
    const glm::vec3 slope_a = (b - before) / 2.0F, slope_b = (behind - a) / 2.0F;
    const float s = 1 - t;
    const glm::vec3 mixed =
        s * s * ((1 + 2 * t) * a + t * slope_a) + t * t * ((1 + 2 * s) * b - s * slope_b);
    const glm::vec3 direction = along(u);
    return {place(u), direction, unit_or(at_right_angles(mixed, direction), any_aside(direction))};
}

}  // namespace palpa
