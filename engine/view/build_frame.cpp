#include "view/build_frame.h"

#include "molecule/residue_kinds.h"
#include "molecule/select.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/select_in_world.h"
#include "simulation/solver.h"
#include "simulation/systems/publish_contact.h"
#include "view/atom_colours.h"
#include "view/contact_pairs.h"
#include "view/draw_layer.h"
#include "view/elements.h"
#include "view/force_parts.h"
#include "view/hydrogen_bonds.h"
#include "view/in_hand.h"
#include "view/measures.h"
#include "view/past.h"
#include "view/pocket.h"
#include "view/residue_structure.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
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

bool are_visible(std::span<const AtomLook> looks, std::size_t a, std::size_t b) {
    return looks[a].visible && looks[b].visible;
}

std::vector<HydrogenBond> find_visible_bonds(std::span<const HydrogenBond> all,
                                             std::span<const AtomLook> looks) {
    std::vector<HydrogenBond> bonds(all.begin(), all.end());
    std::erase_if(bonds, [&](const HydrogenBond& bond) {
        return !are_visible(looks, bond.hydrogen, bond.acceptor);
    });
    return bonds;
}

// Of residues at whose side chains hydrogen bonds end: these from CA on, without hydrogens but
// those of the bonds.
std::vector<bool> find_bond_ends(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                                 std::span<const HydrogenBond> bonds) {
    const auto is_backbone = [&](std::size_t atom) {
        return is_of_backbone(ResidueKind::Protein, atoms.names[atom].atom);
    };
    std::vector<bool> ends(atoms.size(), false);
    for (const HydrogenBond& bond : bonds) {
        for (const std::uint32_t end : {bond.donor, bond.acceptor}) {
            const auto residue = std::ranges::find_if(residues, [&](const ResidueSpan& one) {
                return end >= one.first && end < one.end;
            });
            if (residue == residues.end() || residue->alpha >= residue->end || is_backbone(end))
                continue;
            for (std::size_t i = residue->first; i < residue->end; ++i)
                if (!is_backbone(i) && element_of(atoms, i) != "H") ends[i] = true;
            ends[residue->alpha] = true;
            if (end == bond.donor) ends[bond.hydrogen] = true;
        }
    }
    return ends;
}

// `shown`, of these `bonds`, are used again where they have what is needed.
ContactPairs find_visible_pairs(const FrameParts& parts, ShownBonds which, ShownBonds shown,
                                std::span<const HydrogenBond> bonds,
                                std::span<const AtomLook> looks) {
    std::vector<HydrogenBond> own;
    if (shown != which && shown != ShownBonds::All) {
        own = find_hydrogen_bonds(parts.world, which);
        bonds = own;
    }
    ContactPairs pairs = find_contact_pairs(parts.world, which, parts.residues, bonds);
    const auto is_hidden = [&](const AtomPair& pair) {
        return !are_visible(looks, pair.a, pair.b);
    };
    std::erase_if(pairs.contacts, is_hidden);
    std::erase_if(pairs.salt_bridges, is_hidden);
    std::erase_if(pairs.clashes, [&](const Clash& clash) { return is_hidden(clash.pair); });
    return pairs;
}

// How a layer draws atoms, of which `chosen` are its own.
std::vector<AtomLook> find_layer_looks(std::span<const AtomLook> looks, const ViewLayer& layer,
                                       const std::vector<bool>& chosen) {
    std::vector<AtomLook> shown(looks.begin(), looks.end());
    for (std::size_t atom = 0; atom < shown.size(); ++atom) {
        shown[atom].representation = layer.representation;
        shown[atom].colouring = layer.colouring.value_or(shown[atom].colouring);
        shown[atom].visible = shown[atom].visible && chosen[atom];
    }
    return shown;
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
    const ResidueNames names(atoms, residues);
    for (const ResidueSpan& residue : residues) {
        std::vector<std::size_t> chosen;
        for (std::size_t i = residue.first; i < residue.end; ++i)
            if (selected[i]) chosen.push_back(i);
        if (chosen.empty()) continue;
        const bool is_alone = chosen.size() == 1;
        const std::size_t atom = is_alone                      ? chosen.front()
                                 : residue.alpha < residue.end ? residue.alpha
                                                               : residue.first;
        labels.push_back({as_float(atoms.positions[atom]), names.name(atom, is_alone)});
    }
}

HeldMolecule find_held(const World& world, Entity hand) {
    const AtomRange atoms = held_range(world, hand);
    return {atoms, as_float(held_place(world, hand)),
            as_float(centre_of_mass(world.resource<AtomTable>(), atoms))};
}

void add_signs(const World& world, Entity hand, const ContactModel& contact, FrameScene& frame,
               std::vector<ViewLabel>& labels) {
    if (!world.find<Grip>(hand)) return;
    const HeldMolecule held = find_held(world, hand);
    constexpr double nN = 1e9, angstrom_nN = 1e19;
    add_force(as_float(nN * contact.force_newton), held, frame, labels);
    if (!moves_in_space(world, hand)) return;
    add_torque(as_float(angstrom_nN * contact.torque_newton_metre), held, frame, labels);
}

// For a second and a half, so that it can be read.
void add_last_snap(const World& world, FrameScene& frame, std::vector<ViewLabel>& labels) {
    constexpr double shown_s = 1.5;
    const std::optional<Snap> snap = find_last_snap(world);
    if (!snap) return;
    const Clock& clock = world.resource<Clock>();
    const auto steps = static_cast<double>(clock.steps - snap->step);
    if (steps * clock.period_s > shown_s) return;
    add_snap(as_float(world.resource<AtomTable>().positions[snap->atom]), snap->released, frame,
             labels);
}

}  // namespace

// A selection, and what it selected last.
class KeptSelection {
public:
    explicit KeptSelection(Selection selection)
        : selection_(std::move(selection)), is_constant_(is_constant(selection_)) {}

    // One entry per atom, until the next call. Evaluated anew only where it may have changed.
    const std::vector<bool>& update(const FrameParts& parts) {
        const AtomEdition& now = parts.world.resource<AtomEdition>();
        if (is_constant_ && edition_ == now) return chosen_;
        chosen_ = select_in_world(parts.world, selection_, parts.structure_of_atoms);
        edition_ = now;
        return chosen_;
    }

private:
    Selection selection_;
    bool is_constant_;
    std::optional<AtomEdition> edition_;  // of `chosen_`
    std::vector<bool> chosen_;
};

// What FrameBuilder keeps.
struct FrameBuilder::Kept {
    ResidueStructure structure;
    std::vector<KeptLayer> layers;                                 // that of everything first
    std::map<std::string, KeptSelection> selections{};             // by their texts
    std::map<std::string, std::vector<KeptSelection>> measures{};  // by their texts
    Past past;

    const std::vector<bool>& select(const FrameParts& parts, const std::string& text,
                                    const char* source) {
        auto found = selections.find(text);
        if (found == selections.end())
            found = selections.emplace(text, parse_selection(text, source)).first;
        return found->second.update(parts);
    }
    void draw_layers(const FrameParts& parts, std::span<const AtomLook> looks,
                     const ViewSettings& settings, FrameScene& frame);
    void add_measures(const FrameParts& parts, std::span<const std::string> texts,
                      FrameScene& frame, std::vector<ViewLabel>& labels);
    void add_marks(const FrameParts& parts, const ViewSettings& settings,
                   std::span<const HydrogenBond> bonds, std::span<const AtomLook> looks,
                   FrameScene& frame, std::vector<ViewLabel>& labels);
};

void FrameBuilder::Kept::draw_layers(const FrameParts& parts, std::span<const AtomLook> looks,
                                     const ViewSettings& settings, FrameScene& frame) {
    const std::vector<ViewLayer>& shown = settings.layers;
    layers.resize(1 + shown.size());
    std::vector<AtomLook> not_hidden(looks.begin(), looks.end());
    for (const std::string& text : settings.hidden) {
        const std::vector<bool>& hidden = select(parts, text, "view.hide");
        for (std::size_t i = 0; i < looks.size(); ++i)
            if (hidden[i]) not_hidden[i].visible = false;
    }
    draw_layer(parts, not_hidden, find_layer_colours(parts, not_hidden), 1, layers[0], frame);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const std::vector<bool> chosen = shown[i].of.empty()
                                             ? std::vector<bool>(looks.size(), true)
                                             : select(parts, shown[i].of, "view.layers.of");
        const std::vector<AtomLook> own = find_layer_looks(looks, shown[i], chosen);
        draw_layer(parts, own, find_layer_colours(parts, own), static_cast<float>(shown[i].opacity),
                   layers[1 + i], frame);
    }
}

// Those of which each selection has an atom.
void FrameBuilder::Kept::add_measures(const FrameParts& parts, std::span<const std::string> texts,
                                      FrameScene& frame, std::vector<ViewLabel>& labels) {
    const std::vector<Vec3>& positions = parts.world.resource<AtomTable>().positions;
    for (const std::string& text : texts) {
        auto found = measures.find(text);
        if (found == measures.end()) {
            const std::vector<Selection> parsed = parse_measure(text, "view.measure");
            found = measures.try_emplace(text, parsed.begin(), parsed.end()).first;
        }
        std::vector<Vec3> places;
        for (KeptSelection& selection : found->second) {
            const std::vector<bool>& chosen = selection.update(parts);
            if (std::ranges::find(chosen, true) == chosen.end()) break;
            places.push_back(find_centre(positions, chosen));
        }
        if (places.size() == found->second.size()) add_measure(places, frame, labels);
    }
}

// `bonds`: the hydrogen bonds of the settings, also those of hidden atoms.
void FrameBuilder::Kept::add_marks(const FrameParts& parts, const ViewSettings& settings,
                                   std::span<const HydrogenBond> bonds,
                                   std::span<const AtomLook> looks, FrameScene& frame,
                                   std::vector<ViewLabel>& labels) {
    const World& world = parts.world;
    const ViewMarks& marks = settings.marks;
    if (marks.contacts != ShownBonds::None)
        add_contact_pairs(
            world.resource<AtomTable>(),
            find_visible_pairs(parts, marks.contacts, settings.hydrogen_bonds, bonds, looks), frame,
            labels);
    for (const Entity hand : find_hands(world))
        if (marks.forces != ShownForces::Hand && world.find<Grip>(hand))
            add_force_parts(world, hand, marks.forces, parts.residues, find_held(world, hand),
                            frame, labels);
    if (marks.ghost)
        past.add_ghost(world, parts.residues, find_pocket(world, parts.residues), frame, labels);
    if (marks.trail_s > 0) past.add_trail(marks.trail_s, frame);
    add_measures(parts, marks.measures, frame, labels);
}

FrameBuilder::FrameBuilder() : kept_(std::make_unique<Kept>()) {}
FrameBuilder::FrameBuilder(FrameBuilder&&) noexcept = default;
FrameBuilder& FrameBuilder::operator=(FrameBuilder&&) noexcept = default;
FrameBuilder::~FrameBuilder() = default;

void FrameBuilder::follow(const World& world, const ViewMarks& marks) {
    kept_->past.follow(world, marks);
}

FrameScene FrameBuilder::build(const World& world, std::span<const ContactModel> contacts,
                               const ViewSettings& settings, std::vector<ViewLabel>* labels) {
    follow(world, settings.marks);
    FrameScene frame;
    frame.background = settings.background;
    frame.shadows = settings.shadows != Shadows::None;
    frame.occlusion = settings.occlusion;
    frame.outline = settings.outline;
    std::vector<ViewLabel> words;
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<AtomLook> looks = find_looks(world, settings);
    const std::vector<HydrogenBond> all_bonds = find_hydrogen_bonds(world, settings.hydrogen_bonds);
    const std::vector<HydrogenBond> bonds = find_visible_bonds(all_bonds, looks);
    std::vector<bool> takes_part(atoms.size(), false);
    for (const HydrogenBond& bond : bonds) takes_part[bond.hydrogen] = true;
    const std::vector<ResidueSpan> residues = find_residues(world);
    const std::span<const SecondaryStructure> structure = kept_->structure.update(atoms, residues);
    const std::vector<bool> held = find_held_atoms(world), in_hand = find_in_hand(world);
    const std::vector<SecondaryStructure> of_atoms = per_atom(atoms, residues, structure);
    // All bonds of a protein would show nearly all of its side chains.
    const std::vector<bool> ends = settings.hydrogen_bonds == ShownBonds::InHand
                                       ? find_bond_ends(atoms, residues, bonds)
                                       : std::vector<bool>(atoms.size(), false);
    const FrameParts parts{world,   residues,   structure, of_atoms,          held,
                           in_hand, takes_part, ends,      settings.hydrogens};
    kept_->draw_layers(parts, looks, settings, frame);
    add_hydrogen_bonds(atoms, bonds, frame, words);
    for (const std::string& text : settings.labels)
        add_selection_labels(atoms, residues, kept_->select(parts, text, "view.label"), words);
    const std::vector<Entity> hands = find_hands(world);
    for (std::size_t i = 0; settings.force_arrow && i < contacts.size(); ++i)
        add_signs(world, hands[i], contacts[i], frame, words);
    kept_->add_marks(parts, settings, all_bonds, looks, frame, words);
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
