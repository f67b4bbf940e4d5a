#include "view/lines.h"

#include "view/picks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace palpa {
namespace {

// What belongs to atoms, or was before, is hidden by what is in front of it.
bool is_on_top(std::uint32_t pick) {
    return pick != hydrogen_bond_pick && pick != contact_pick && pick != salt_bridge_pick &&
           pick != ghost_pick && pick != rest_pick;
}

}  // namespace

void add_stick(const glm::vec3& a, const glm::vec3& b, const LineLook& look, FrameScene& frame) {
    frame.cones.push_back({a, b, look.radius, look.radius, look.colour, look.colour, look.pick,
                           is_on_top(look.pick)});
}

void add_ball(const glm::vec3& centre, const LineLook& look, FrameScene& frame) {
    frame.spheres.push_back({centre, look.radius, look.colour, look.pick, is_on_top(look.pick)});
}

void add_head(const glm::vec3& from, const glm::vec3& tip, const LineLook& look,
              FrameScene& frame) {
    frame.cones.push_back({from, tip, look.radius, 0.02F * look.radius, look.colour, look.colour,
                           look.pick, is_on_top(look.pick)});
}

void add_disc(const glm::vec3& centre, const glm::vec3& axis, const LineLook& look,
              FrameScene& frame) {
    constexpr float half = 0.09F;                                        // of the radius
    add_stick(centre, centre + half * look.radius * axis, look, frame);  // flat at its first end
    add_stick(centre, centre - half * look.radius * axis, look, frame);
}

void add_dashes(const glm::vec3& a, const glm::vec3& b, float dash, const LineLook& look,
                FrameScene& frame) {
    constexpr float gap = 0.75F;  // of a dash
    const float length = glm::distance(a, b);
    const auto count = static_cast<int>(std::lround((length / dash + gap) / (1 + gap)));
    if (count < 1 || !(length > 0)) return;
    const glm::vec3 along = (b - a) / length;
    const float each = length / (static_cast<float>(count) + gap * static_cast<float>(count - 1));
    for (int i = 0; i < count; ++i) {
        const glm::vec3 from = a + (1 + gap) * each * static_cast<float>(i) * along;
        add_stick(from, from + each * along, look, frame);
    }
}

glm::vec3 Arc::place(float angle) const {
    return centre + radius * (std::cos(angle) * right + std::sin(angle) * up);
}

void add_arc(const Arc& arc, const LineLook& look, FrameScene& frame, int every) {
    constexpr float longest = std::numbers::pi_v<float> / 15;
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(arc.sweep) / longest)));
    const float step = arc.sweep / static_cast<float>(pieces);
    for (int i = 0; i < pieces; i += every) {
        const float from = step * static_cast<float>(i);
        add_stick(arc.place(from), arc.place(from + step), look, frame);
        if (every == 1) add_ball(arc.place(from + step), look, frame);
    }
}

std::pair<glm::vec3, glm::vec3> across(const glm::vec3& axis) {
    const glm::vec3 size = glm::abs(axis);
    const glm::vec3 other = size.x <= size.y && size.x <= size.z ? glm::vec3(1, 0, 0)
                            : size.y <= size.z                   ? glm::vec3(0, 1, 0)
                                                                 : glm::vec3(0, 0, 1);
    const glm::vec3 first = glm::normalize(glm::cross(axis, other));
    return {first, glm::cross(axis, first)};
}

}  // namespace palpa
