// Building blocks of signs and marks: sticks, dashes, arrows, discs and arcs, in Å.
#pragma once
#include "render/frame_scene.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <utility>

namespace palpa {

// Appearance of a line; its pick (view/picks.h) decides whether it is drawn on top of atoms.
struct LineLook {
    float radius = 0.05F;  // Å
    glm::vec3 colour{0};
    std::uint32_t pick = 0;
};

void add_stick(const glm::vec3& a, const glm::vec3& b, const LineLook& look, FrameScene& frame);

// A ball of the line's radius, which closes an open end of a stick.
void add_ball(const glm::vec3& centre, const LineLook& look, FrameScene& frame);

// A pointed cone, of the look's radius at its foot.
void add_head(const glm::vec3& from, const glm::vec3& tip, const LineLook& look, FrameScene& frame);

// A flat disc of the look's radius, visible from both sides. `axis`: a unit vector.
void add_disc(const glm::vec3& centre, const glm::vec3& axis, const LineLook& look,
              FrameScene& frame);

// A dashed line between two points that begins and ends with a dash. Nothing if they are closer
// than half a dash.
void add_dashes(const glm::vec3& a, const glm::vec3& b, float dash, const LineLook& look,
                FrameScene& frame);

// A part of a circle: from `centre + radius * right` towards `up` (orthogonal unit vectors) by
// `sweep` (rad).
struct Arc {
    glm::vec3 centre{0}, right{1, 0, 0}, up{0, 1, 0};
    float radius = 1, sweep = 0;

    glm::vec3 place(float angle) const;
};

// Straight segments of 12° at most; `every`: 1 draws all of them, 2 every second one.
void add_arc(const Arc& arc, const LineLook& look, FrameScene& frame, int every = 1);

// Two unit vectors orthogonal to an axis, right-handed with it.
std::pair<glm::vec3, glm::vec3> across(const glm::vec3& axis);

}  // namespace palpa
