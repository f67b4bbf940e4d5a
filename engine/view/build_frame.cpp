#include "view/build_frame.h"

#include "molecule/select.h"
#include "simulation/components.h"
#include "simulation/held.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/select_in_world.h"
#include "simulation/systems/publish_contact.h"
#include "view/atom_colours.h"
#include "view/draw_layer.h"
#include "view/hydrogen_bonds.h"
#include "view/in_hand.h"
#include "view/pocket.h"
#include "view/residue_structure.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

std::vector<AtomLook> find_looks(const World& world, const ViewSettings& settings) {
    std::vector<AtomLook> looks(world.resource<AtomTable>().size(),
                                {settings.representation, settings.colouring, true});
    world.each<Molecule, Appearance>([&](Entity, const Molecule& molecule,
                                         const Appearance& appearance) {
        const AtomLook look{appearance.representation.value_or(settings.representation),
                            appearance.colouring.value_or(settings.colouring), appearance.visible};
        std::fill_n(looks.begin() + molecule.atoms.first, molecule.atoms.count, look);
    });
    return looks;
}

std::vector<SecondaryStructure> per_atom(const AtomTable& atoms,
                                         std::span<const ResidueSpan> residues,
                                         std::span<const SecondaryStructure> structure) {
    std::vector<SecondaryStructure> of_atoms(atoms.size(), SecondaryStructure::Coil);
    for (std::size_t i = 0; i < residues.size(); ++i)
        for (std::size_t atom = residues[i].first; atom < residues[i].end; ++atom)
            of_atoms[atom] = structure[i];
    return of_atoms;
}

// One an atom, by how each is to be coloured.
std::vector<glm::vec3> find_layer_colours(const FrameParts& parts,
                                          std::span<const AtomLook> looks) {
    std::vector<glm::vec3> colours(looks.size());
    std::array<std::vector<glm::vec3>, colouring_names.size()> found;
    for (std::size_t i = 0; i < looks.size(); ++i) {
        std::vector<glm::vec3>& of = found[static_cast<std::size_t>(looks[i].colouring)];
        if (of.empty())
            of = find_colours(parts.world, looks[i].colouring, parts.residues, parts.structure);
        colours[i] = of[i];
    }
    return colours;
}

// Atoms alone beside themselves, residues of which more is selected beside their CA, or first atom.
void add_selection_labels(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                          const std::vector<bool>& selected, std::vector<ViewLabel>& labels) {
    for (const ResidueSpan& residue : residues) {
        std::vector<std::size_t> chosen;
        for (std::size_t i = residue.first; i < residue.end; ++i)
            if (selected[i]) chosen.push_back(i);
        if (chosen.empty()) continue;
        const bool is_alone = chosen.size() == 1;
        const std::size_t atom = is_alone                      ? chosen.front()
                                 : residue.alpha < residue.end ? residue.alpha
                                                               : residue.first;
        const AtomName& name = atoms.names[atom];
        const std::string text = fmt::format("{} {}{}", name.residue, name.number,
                                             is_alone ? " " + name.atom : std::string());
        labels.push_back({as_float(atoms.positions[atom]), text});
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

// The caches of FrameBuilder.
struct FrameBuilder::Kept {
    ResidueStructure structure;
    std::vector<KeptLayer> layers;                  // that of everything first
    std::map<std::string, Selection> selections{};  // by their texts

    const Selection& parsed(const std::string& text, const char* source) {
        const auto found = selections.find(text);
        if (found != selections.end()) return found->second;
        return selections.emplace(text, parse_selection(text, source)).first->second;
    }
};

FrameBuilder::FrameBuilder() : kept_(std::make_unique<Kept>()) {}
FrameBuilder::FrameBuilder(FrameBuilder&&) noexcept = default;
FrameBuilder& FrameBuilder::operator=(FrameBuilder&&) noexcept = default;
FrameBuilder::~FrameBuilder() = default;

FrameScene FrameBuilder::build(const World& world, std::span<const ContactModel> contacts,
                               const ViewSettings& settings, std::vector<ViewLabel>* labels) {
    FrameScene frame;
    frame.shadows = settings.shadows != Shadows::None;
    frame.occlusion = settings.occlusion;
    frame.outline = settings.outline;
    std::vector<ViewLabel> words;
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<AtomLook> looks = find_looks(world, settings);
    std::vector<HydrogenBond> bonds = find_hydrogen_bonds(world, settings.hydrogen_bonds);
    std::erase_if(bonds, [&](const HydrogenBond& bond) {
        return !looks[bond.hydrogen].visible || !looks[bond.acceptor].visible;
    });
    std::vector<bool> takes_part(atoms.size(), false);
    for (const HydrogenBond& bond : bonds) takes_part[bond.hydrogen] = true;
    const std::vector<ResidueSpan> residues = find_residues(world);
    const std::span<const SecondaryStructure> structure = kept_->structure.update(atoms, residues);
    const std::vector<bool> held = find_held_atoms(world), in_hand = find_in_hand(world);
    const FrameParts parts{world,   residues,   structure,         held,
                           in_hand, takes_part, settings.hydrogens};
    const auto select = [&](const std::string& text, const char* source) {
        return select_in_world(world, kept_->parsed(text, source),
                               per_atom(atoms, residues, structure));
    };
    kept_->layers.resize(1 + settings.layers.size());
    const auto draw = [&](std::span<const AtomLook> shown, float opacity, KeptLayer& kept) {
        draw_layer(parts, shown, find_layer_colours(parts, shown), opacity, kept, frame);
    };
    std::vector<AtomLook> not_hidden = looks;
    for (const std::string& text : settings.hidden) {
        const std::vector<bool> hidden = select(text, "view.hide");
        for (std::size_t i = 0; i < looks.size(); ++i)
            if (hidden[i]) not_hidden[i].visible = false;
    }
    draw(not_hidden, 1, kept_->layers[0]);
    for (std::size_t i = 0; i < settings.layers.size(); ++i) {
        const ViewLayer& layer = settings.layers[i];
        std::vector<AtomLook> shown = looks;
        const std::vector<bool> chosen = layer.of.empty() ? std::vector<bool>(atoms.size(), true)
                                                          : select(layer.of, "view.layers.of");
        for (std::size_t atom = 0; atom < shown.size(); ++atom) {
            shown[atom].representation = layer.representation;
            shown[atom].colouring = layer.colouring.value_or(shown[atom].colouring);
            shown[atom].visible = shown[atom].visible && chosen[atom];
        }
        draw(shown, static_cast<float>(layer.opacity), kept_->layers[1 + i]);
    }
    add_hydrogen_bonds(atoms, bonds, frame, words);
    for (const std::string& text : settings.labels)
        add_selection_labels(atoms, residues, select(text, "view.label"), words);
    const std::vector<Entity> hands = find_hands(world);
    for (std::size_t i = 0; settings.force_arrow && i < contacts.size(); ++i)
        add_signs(world, hands[i], contacts[i], frame, words);
    add_last_snap(world, frame, words);
    if (labels) *labels = std::move(words);
    return frame;
}

std::vector<ContactModel> find_contacts(const World& world) {
    std::vector<ContactModel> contacts;
    for (const Entity hand : find_hands(world)) {
        const bool holds = world.find<Grip>(hand) != nullptr;
        contacts.push_back(holds ? build_local_contact(world, hand, {}).model : ContactModel{});
    }
    return contacts;
}

FrameScene build_frame(const World& world, std::span<const ContactModel> contacts,
                       const ViewSettings& settings, std::vector<ViewLabel>* labels) {
    return FrameBuilder().build(world, contacts, settings, labels);
}

FrameScene build_frame(const World& world, const ViewSettings& settings,
                       std::vector<ViewLabel>* labels) {
    return build_frame(world, find_contacts(world), settings, labels);
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
