#include "view/build_frame.h"

#include "core/units.h"
#include "simulation/components.h"
#include "simulation/step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string_view>

namespace palpa {
namespace {

// Van der Waals radii: A. Bondi, J. Phys. Chem. 68, 441 (1964). Colours: oxygen red, nitrogen blue,
// sulphur yellow as chemists are used to.
struct ElementLook {
    std::string_view element;
    float radius;  // Å
    glm::vec3 colour;
};

constexpr std::array looks = std::to_array<ElementLook>({
    {"H", 1.20F, {0.87F, 0.87F, 0.87F}},
    {"C", 1.70F, {0.32F, 0.34F, 0.37F}},
    {"N", 1.55F, {0.13F, 0.25F, 0.80F}},
    {"O", 1.52F, {0.78F, 0.06F, 0.06F}},
    {"P", 1.80F, {0.85F, 0.40F, 0.05F}},
    {"S", 1.80F, {0.85F, 0.70F, 0.08F}},
});
constexpr ElementLook other{"", 1.70F, {0.70F, 0.20F, 0.60F}};

constexpr float ball_share = 0.28F, stick_radius = 0.14F, licorice_radius = 0.28F;
constexpr float margin = 1.15F;  // around all atoms

const ElementLook& look_of(std::string_view element) {
    const auto found = std::find_if(looks.begin(), looks.end(), [&](const ElementLook& look) {
        return look.element == element;
    });
    return found == looks.end() ? other : *found;
}

glm::vec3 as_float(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

void add_atoms(const AtomTable& atoms, Representation representation, FrameScene& frame) {
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const ElementLook& look = look_of(atoms.element[i]);
        const float radius = representation == Representation::SpaceFilling ? look.radius
                             : representation == Representation::BallAndStick
                                 ? ball_share * look.radius
                                 : licorice_radius;
        frame.spheres.push_back(
            {as_float(atoms.positions[i]), radius, look.colour, static_cast<std::uint32_t>(i)});
    }
}

void add_bonds(const AtomTable& atoms, Representation representation, FrameScene& frame) {
    if (representation == Representation::SpaceFilling) return;
    const float radius =
        representation == Representation::BallAndStick ? stick_radius : licorice_radius;
    for (const auto& [a, b] : atoms.bonds) {
        frame.cones.push_back({as_float(atoms.positions[a]), as_float(atoms.positions[b]), radius,
                               radius, look_of(atoms.element[a]).colour,
                               look_of(atoms.element[b]).colour, a});
    }
}

void add_force_arrow(const Simulation& simulation, FrameScene& frame) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    const Molecule& grabbed = *simulation.world.find<Molecule>(grab.molecule);
    const Vec3 force_nN = build_touch_model(simulation, {}).force_newton * 1e9;
    const double length = std::min(5 * force_nN.norm(), 3.0);  // Å
    if (!(length > 0.05)) return;
    const Vec3 from = simulation.atoms.positions[grabbed.reference_atom];
    const Vec3 along = force_nN.normalized();
    const Vec3 neck = from + std::max(length - 0.5, 0.5 * length) * along;
    const glm::vec3 colour{0.95F, 0.45F, 0.02F};
    frame.cones.push_back(
        {as_float(from), as_float(neck), 0.09F, 0.09F, colour, colour, arrow_pick});
    frame.cones.push_back({as_float(neck), as_float(from + length * along), 0.24F, 0.005F, colour,
                           colour, arrow_pick});
}

// Looks along -z at the middle of all shapes, from where the nearest side of the box around them
// fills the picture one way or the other.
FrameCamera frame_all(const FrameScene& frame, float aspect) {
    FrameCamera camera;
    if (frame.spheres.empty()) return camera;
    glm::vec3 low = frame.spheres[0].centre, high = low;
    const auto include = [&](const glm::vec3& place, float radius) {
        low = glm::min(low, place - radius);
        high = glm::max(high, place + radius);
    };
    for (const SphereShape& sphere : frame.spheres) include(sphere.centre, sphere.radius);
    for (const ConeShape& cone : frame.cones) {
        include(cone.a, cone.radius_a);
        include(cone.b, cone.radius_b);
    }
    const glm::vec3 half = 0.5F * (high - low);
    const float slope = std::tan(camera.vertical_angle / 2);
    const float distance = half.z + margin * std::max(half.y / slope, half.x / (slope * aspect));
    const float depth = 2 * glm::length(half);
    camera.target = 0.5F * (low + high);
    camera.eye = camera.target + glm::vec3(0, 0, distance);
    camera.near = std::max(0.02F * distance, distance - depth);
    camera.far = distance + depth;
    return camera;
}

}  // namespace

FrameScene build_frame(const Simulation& simulation, const ViewSettings& settings, float aspect) {
    FrameScene frame;
    add_atoms(simulation.atoms, settings.representation, frame);
    add_bonds(simulation.atoms, settings.representation, frame);
    if (settings.force_arrow) add_force_arrow(simulation, frame);
    frame.camera = frame_all(frame, aspect);
    return frame;
}

}  // namespace palpa
