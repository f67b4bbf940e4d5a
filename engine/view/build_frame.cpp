#include "view/build_frame.h"

#include "simulation/components.h"
#include "simulation/held.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/systems/publish_contact.h"
#include "view/elements.h"
#include "view/hydrogen_bonds.h"
#include "view/in_hand.h"
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

// How an atom is drawn: as everything, or as its molecule says.
struct AtomLook {
    Representation representation;
    Colouring colouring;
    bool visible = true;
};

std::vector<AtomLook> find_looks(const World& world, const ViewSettings& settings) {
    std::vector<AtomLook> looks(world.resource<AtomTable>().size(),
                                {settings.representation, settings.colouring});
    world.each<Molecule, Appearance>([&](Entity, const Molecule& molecule,
                                         const Appearance& appearance) {
        const AtomLook look{appearance.representation.value_or(settings.representation),
                            appearance.colouring.value_or(settings.colouring), appearance.visible};
        std::fill_n(looks.begin() + molecule.atoms.first, molecule.atoms.count, look);
    });
    return looks;
}

// One colour an atom.
std::vector<glm::vec3> build_colours(const World& world, std::span<const AtomLook> looks) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<bool> held = find_held_atoms(world);
    std::size_t chain = 0;
    const AtomName* before = nullptr;  // the last that is not held
    std::vector<glm::vec3> colours;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        if (!held[i]) {
            if (before && before->segment != atoms.names[i].segment) ++chain;
            before = &atoms.names[i];
        }
        const std::string_view element = element_of(atoms, i);
        colours.push_back(look_of(element).colour);
        if (element != "C") continue;
        if (held[i]) {
            colours.back() = grabbed_carbon;
        } else if (looks[i].colouring == Colouring::Chain) {
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

// Draws the backbones of what is shown as a pocket. Which atoms of that stand for themselves; empty
// where there is none.
std::vector<bool> add_pockets(const World& world, std::span<const glm::vec3> colours,
                              std::span<const AtomLook> looks, FrameScene& frame) {
    const auto is_pocket = [](const AtomLook& look) {
        return look.visible && look.representation == Representation::Pocket;
    };
    if (std::ranges::none_of(looks, is_pocket)) return {};
    std::vector<ResidueSpan> residues = find_residues(world);
    std::erase_if(residues,
                  [&](const ResidueSpan& residue) { return !is_pocket(looks[residue.first]); });
    add_backbones(world.resource<AtomTable>(), residues, colours, frame);
    return find_pocket(world, residues);
}

// `bonded`: the hydrogens of these are drawn, whatever the representation leaves out.
void add_shapes(const World& world, std::span<const glm::vec3> colours,
                std::span<const AtomLook> looks, std::span<const HydrogenBond> bonded,
                FrameScene& frame) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<bool> held = find_in_hand(world);
    const std::vector<bool> stands = add_pockets(world, colours, looks, frame);
    std::vector<bool> takes_part(atoms.size(), false);
    for (const HydrogenBond& bond : bonded) takes_part[bond.hydrogen] = true;
    std::vector<float> sticks;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        const Representation shown_as = looks[i].representation;
        auto [atom, stick] = thickness_of(shown_as, element_of(atoms, i), held[i]);
        if (atom == 0 && takes_part[i]) atom = stick = thin_radius;
        const bool is_pocket = shown_as == Representation::Pocket && !held[i];
        if (!looks[i].visible || (is_pocket && !stands[i])) atom = stick = 0;
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

void add_signs(const World& world, Entity hand, const ContactModel& contact, FrameScene& frame,
               std::vector<ViewLabel>& labels) {
    if (!world.find<Grip>(hand)) return;
    const AtomRange atoms = held_range(world, hand);
    const HeldMolecule held{atoms, as_float(held_place(world, hand)),
                            as_float(centre_of_mass(world.resource<AtomTable>(), atoms))};
    constexpr double nN = 1e9, angstrom_nN = 1e19;
    add_force(as_float(nN * contact.force_newton), held, frame, labels);
    if (!moves_in_space(world, hand)) return;
    add_torque(as_float(angstrom_nN * contact.torque_newton_metre), held, frame, labels);
}

// For a second and a half, so that it can be read.
void add_last_snap(const World& world, FrameScene& frame, std::vector<ViewLabel>& labels) {
    constexpr double shown_s = 1.5;
    const SecondOrder* const second = world.find_resource<SecondOrder>();
    if (!second || !second->snap) return;
    const Clock& clock = world.resource<Clock>();
    const auto steps = static_cast<double>(clock.steps - second->snap->step);
    if (steps * clock.period_s > shown_s) return;
    add_snap(as_float(world.resource<AtomTable>().positions[second->snap->atom]),
             second->snap->released, frame, labels);
}

}  // namespace

glm::vec3 as_float(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

FrameScene build_frame(const World& world, std::span<const ContactModel> contacts,
                       const ViewSettings& settings, std::vector<ViewLabel>* labels) {
    FrameScene frame;
    std::vector<ViewLabel> words;
    const std::vector<AtomLook> looks = find_looks(world, settings);
    const std::vector<glm::vec3> colours = build_colours(world, looks);
    std::vector<HydrogenBond> bonds = find_hydrogen_bonds(world, settings.hydrogen_bonds);
    std::erase_if(bonds, [&](const HydrogenBond& bond) {
        return !looks[bond.hydrogen].visible || !looks[bond.acceptor].visible;
    });
    add_shapes(world, colours, looks, bonds, frame);
    add_hydrogen_bonds(world.resource<AtomTable>(), bonds, frame, words);
    const std::vector<Entity> hands = find_hands(world);
    for (std::size_t i = 0; settings.force_arrow && i < contacts.size(); ++i)
        add_signs(world, hands[i], contacts[i], frame, words);
    add_last_snap(world, frame, words);
    if (labels) *labels = std::move(words);
    return frame;
}

FrameScene build_frame(const World& world, const ViewSettings& settings) {
    std::vector<ContactModel> contacts;
    for (const Entity hand : find_hands(world)) {
        const bool holds = world.find<Grip>(hand) != nullptr;
        contacts.push_back(holds ? build_local_contact(world, hand, {}).model : ContactModel{});
    }
    return build_frame(world, contacts, settings);
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
