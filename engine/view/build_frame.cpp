#include "view/build_frame.h"

#include "simulation/components.h"
#include "simulation/probe.h"
#include "simulation/touch.h"
#include "view/elements.h"
#include "view/hydrogen_bonds.h"
#include "view/palette.h"
#include "view/pocket.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr float ball_share = 0.28F, stick_radius = 0.14F, licorice_radius = 0.28F;
constexpr float thin_radius = 0.11F;

const ElementLook& look_of(std::string_view element) {
    const auto found = std::ranges::find(element_looks, element, &ElementLook::element);
    return found == element_looks.end() ? other_element : *found;
}

// The atoms in the hand: a molecule, the first of the table, or what of it is held by a spring.
std::vector<bool> find_held_atoms(const Simulation& simulation) {
    std::vector<bool> held(simulation.atoms.size(), false);
    if (simulation.flexible && simulation.flexible->state.tether) {
        for (const std::uint32_t atom : simulation.flexible->state.tether->atoms) held[atom] = true;
    } else {
        std::fill_n(held.begin(), grabbed_points(simulation).positions.size(), true);
    }
    return held;
}

// One colour an atom.
std::vector<glm::vec3> build_colours(const Simulation& simulation, Colouring colouring) {
    const AtomTable& atoms = simulation.atoms;
    const std::vector<bool> held = find_held_atoms(simulation);
    std::size_t chain = 0;
    bool is_first = true;  // of those that are not held
    std::vector<glm::vec3> colours;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const bool is_next = i > 0 && atoms.names[i].segment != atoms.names[i - 1].segment;
        if (!held[i] && !std::exchange(is_first, false) && is_next) ++chain;
        const std::string_view element = element_of(atoms, i);
        colours.push_back(look_of(element).colour);
        if (element != "C") continue;
        if (held[i]) {
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

// Of others only hydrogens of hydrogen bonds are drawn where they are thin.
Thickness thickness_of(Representation representation, std::string_view element, bool in_hand) {
    const float size = look_of(element).radius;
    switch (representation) {
        case Representation::SpaceFilling:
            return {size, 0};
        case Representation::Licorice:
            return {licorice_radius, licorice_radius};
        case Representation::InHand:
        case Representation::Pocket:
            if (in_hand) break;
            return element == "H" ? Thickness{} : Thickness{thin_radius, thin_radius};
        case Representation::BallAndStick:
            break;
    }
    return {ball_share * size, stick_radius};
}

// `bonded`: the hydrogens of these are drawn, whatever the representation leaves out.
void add_shapes(const Simulation& simulation, std::span<const glm::vec3> colours,
                Representation representation, std::span<const HydrogenBond> bonded,
                FrameScene& frame) {
    const AtomTable& atoms = simulation.atoms;
    const std::size_t grabbed = grabbed_points(simulation).positions.size();
    std::vector<bool> stands;  // for itself; empty: every atom
    if (representation == Representation::Pocket) {
        const std::vector<Residue> residues = find_residues(simulation);
        stands = find_pocket(simulation, residues);
        add_backbones(atoms, residues, colours, frame);
    }
    std::vector<bool> takes_part(atoms.size(), false);
    for (const HydrogenBond& bond : bonded) takes_part[bond.hydrogen] = true;
    std::vector<float> sticks;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        auto [atom, stick] = thickness_of(representation, element_of(atoms, i), i < grabbed);
        if (atom == 0 && takes_part[i]) atom = stick = thin_radius;
        if (i >= grabbed && !stands.empty() && !stands[i]) atom = stick = 0;
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

void add_signs(const Simulation& simulation, const TouchModel& touch, FrameScene& frame,
               std::vector<ViewLabel>& labels) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    const AtomRange& atoms = simulation.world.find<Molecule>(grab.molecule)->atoms;
    const HeldMolecule held{atoms.first + atoms.count, as_float(grabbed_place(simulation)),
                            as_float(centre_of_mass(simulation.atoms, atoms))};
    constexpr double nN = 1e9, angstrom_nN = 1e19;
    add_force(as_float(nN * touch.force_newton), held, frame, labels);
    if (!moves_in_space(simulation)) return;
    add_torque(as_float(angstrom_nN * touch.torque_newton_metre), held, frame, labels);
}

}  // namespace

glm::vec3 as_float(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

FrameScene build_frame(const Simulation& simulation, const TouchModel& touch,
                       const ViewSettings& settings, std::vector<ViewLabel>* labels) {
    FrameScene frame;
    std::vector<ViewLabel> words;
    const std::vector<glm::vec3> colours = build_colours(simulation, settings.colouring);
    std::vector<HydrogenBond> bonds;
    if (settings.hydrogen_bonds) bonds = find_hydrogen_bonds(simulation);
    add_shapes(simulation, colours, settings.representation, bonds, frame);
    add_hydrogen_bonds(simulation.atoms, bonds, frame, words);
    if (settings.force_arrow) add_signs(simulation, touch, frame, words);
    if (labels) *labels = std::move(words);
    return frame;
}

FrameScene build_frame(const Simulation& simulation, const ViewSettings& settings) {
    return build_frame(simulation, build_touch(simulation, {}).model, settings);
}

std::vector<SphereShape> shapes_of(const FrameScene& frame, const AtomRange& atoms) {
    std::vector<SphereShape> shapes;
    for (const SphereShape& sphere : frame.spheres) {
        if (sphere.pick >= atoms.first && sphere.pick - atoms.first < atoms.count) {
            shapes.push_back(sphere);
        }
    }
    return shapes;
}

}  // namespace palpa
