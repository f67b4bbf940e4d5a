#include "view/build_frame.h"

#include "core/units.h"
#include "simulation/components.h"
#include "simulation/touch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

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
constexpr float thin_radius = 0.09F;

// Of carbons: the grabbed molecule's, and the chains' in turn. Green is no element's, and stands
// out against all of the others.
constexpr glm::vec3 grabbed_carbon{0.08F, 0.50F, 0.12F};
constexpr std::array chain_carbons = std::to_array<glm::vec3>(
    {{0.22F, 0.46F, 0.55F}, {0.58F, 0.44F, 0.24F}, {0.46F, 0.30F, 0.50F}, {0.36F, 0.42F, 0.24F}});

const ElementLook& look_of(std::string_view element) {
    const auto found = std::find_if(looks.begin(), looks.end(), [&](const ElementLook& look) {
        return look.element == element;
    });
    return found == looks.end() ? other : *found;
}

// As the force field names it, or by the atom's first letter.
std::string_view element_of(const AtomTable& atoms, std::size_t i) {
    if (!atoms.element[i].empty()) return atoms.element[i];
    const std::string_view name = atoms.names[i].atom;
    const std::size_t letter = name.find_first_not_of("0123456789");
    return letter == std::string_view::npos ? name : name.substr(letter, 1);
}

// One colour an atom.
std::vector<glm::vec3> build_colours(const Simulation& simulation, Colouring colouring) {
    const AtomTable& atoms = simulation.atoms;
    const std::size_t grabbed = grabbed_points(simulation).positions.size();
    std::size_t chain = 0;
    std::vector<glm::vec3> colours;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (i > grabbed && atoms.names[i].segment != atoms.names[i - 1].segment) ++chain;
        const std::string_view element = element_of(atoms, i);
        colours.push_back(look_of(element).colour);
        if (element != "C") continue;
        if (i < grabbed) {
            colours.back() = grabbed_carbon;
        } else if (colouring == Colouring::Chain) {
            colours.back() = chain_carbons[chain % chain_carbons.size()];
        }
    }
    return colours;
}

// How thick an atom and the sticks at it are drawn (Å); 0: not at all.
struct Thickness {
    float atom = 0, stick = 0;
};

Thickness thickness_of(Representation representation, std::string_view element, bool in_hand) {
    const float size = look_of(element).radius;
    switch (representation) {
        case Representation::SpaceFilling:
            return {size, 0};
        case Representation::Licorice:
            return {licorice_radius, licorice_radius};
        case Representation::InHand:
            if (in_hand) break;
            return element == "H" ? Thickness{} : Thickness{thin_radius, thin_radius};
        case Representation::BallAndStick:
            break;
    }
    return {ball_share * size, stick_radius};
}

void add_shapes(const Simulation& simulation, std::span<const glm::vec3> colours,
                Representation representation, FrameScene& frame) {
    const AtomTable& atoms = simulation.atoms;
    const std::size_t grabbed = grabbed_points(simulation).positions.size();
    std::vector<float> sticks;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const auto [atom, stick] = thickness_of(representation, element_of(atoms, i), i < grabbed);
        sticks.push_back(stick);
        if (atom == 0) continue;
        frame.spheres.push_back(
            {as_float(atoms.positions[i]), atom, colours[i], static_cast<std::uint32_t>(i)});
    }
    for (const auto& [a, b] : atoms.bonds) {
        const float radius = std::min(sticks[a], sticks[b]);
        if (radius == 0) continue;
        frame.cones.push_back({as_float(atoms.positions[a]), as_float(atoms.positions[b]), radius,
                               radius, colours[a], colours[b], a});
    }
}

void add_force_arrow(const Simulation& simulation, const TouchModel& touch, FrameScene& frame) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    const Molecule& grabbed = *simulation.world.find<Molecule>(grab.molecule);
    const Vec3 force_nN = touch.force_newton * 1e9;
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

}  // namespace

void add_wish(const Vec3& place, const Vec3& wish, FrameScene& frame) {
    if (!((wish - place).norm() > 0.1)) return;
    const glm::vec3 colour{0.45F, 0.60F, 0.80F};
    frame.spheres.push_back({as_float(wish), 0.14F, colour, wish_pick});
    frame.cones.push_back(
        {as_float(place), as_float(wish), 0.03F, 0.03F, colour, colour, wish_pick});
}

glm::vec3 as_float(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

FrameScene build_frame(const Simulation& simulation, const TouchModel& touch,
                       const ViewSettings& settings) {
    FrameScene frame;
    const std::vector<glm::vec3> colours = build_colours(simulation, settings.colouring);
    add_shapes(simulation, colours, settings.representation, frame);
    if (settings.force_arrow) add_force_arrow(simulation, touch, frame);
    return frame;
}

FrameScene build_frame(const Simulation& simulation, const ViewSettings& settings) {
    return build_frame(simulation, build_touch(simulation, {}).model, settings);
}

ViewSettings default_view(const Simulation& simulation) {
    constexpr std::size_t many = 300;
    const bool hides = environment_points(simulation).positions.size() > many;
    return {.representation = hides ? Representation::InHand : Representation::BallAndStick};
}

}  // namespace palpa
