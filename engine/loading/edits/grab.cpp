#include "loading/edits/changes.h"
#include "scene/edits.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/resources.h"
#include "simulation/solver.h"

#include <fmt/format.h>
#include <utility>

namespace palpa {
namespace {

Motion motion_in_hand(const World& world, Entity hand) {
    if (needs_mechanics(world)) return Motion::TranslateAndTurn;
    return world.find<Hand>(hand)->turns ? Motion::WithHandle : Motion::Translate;
}

// The molecule that the hand's distances are measured from, or the held one itself.
Entity find_origin(const World& world, Entity hand, Entity molecule) {
    const Entity origin = molecule_called(world, world.find<GripSettings>(hand)->measured_from);
    return origin == Entity{} ? molecule : origin;
}

// Adds the hand's spring, as stiff as the scene has it, if `part` has atoms.
void set_spring(World& world, Entity hand, const AtomsOf& part) {
    if (part.atoms.empty()) return;
    hold_by_spring(world, hand, part,
                   world.find<GripSettings>(hand)->spring_kcal_per_mol_angstrom2);
}

Grip build_grip(const World& world, Entity hand, const AtomsOf& part) {
    Grip grip;
    grip.molecule = part.molecule;
    // Keeps the mobility that the molecule has while no hand holds it.
    const Entity other = other_holder(world, {}, part.molecule);
    grip.before =
        other == Entity{} ? *world.find<Mobility>(part.molecule) : grip_of(world, other).before;
    grip.measured_from = find_origin(world, hand, part.molecule);
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    const Molecule& origin = *world.find<Molecule>(grip.measured_from);
    const Molecule& molecule = *world.find<Molecule>(part.molecule);
    grip.anchor = positions[origin.reference_atom];
    const bool is_whole = part.atoms.empty();
    const Vec3 place = is_whole ? positions[molecule.reference_atom] : middle_of(world, part);
    grip.pose.place_angstrom = place - grip.anchor;
    grip.line_origin = grip.pose.place_angstrom;
    grip.projector = Mat3::Identity();
    grip.freedom = 3;
    grip.is_new = false;
    return grip;
}

}  // namespace

void GrabEdit::apply(World& world, std::size_t slot) const {
    const Entity hand = find_hand(world, slot);
    edit_whole(world, [&](World& changed) {
        AtomsOf part = find_atoms(changed, what);
        release(changed, hand);
        // A remote engine's atoms are held by springs alone.
        if (!places_atoms(changed)) {
            if (part.atoms.empty()) part.atoms = all_atoms_of(changed, part.molecule);
            changed.set(hand, build_grip(changed, hand, part));
            set_spring(changed, hand, part);
            begin_new_grip(changed, hand);
            return;
        }
        const bool is_whole = part.atoms.empty();
        const Entity other = other_holder(changed, hand, part.molecule);
        if (is_whole && other != Entity{} && holds_whole(changed, other)) {
            const AtomName& atom = changed.resource<AtomTable>()
                                       .names[changed.find<Molecule>(part.molecule)->atoms.first];
            refuse(
                fmt::format("another hand holds '{0}' as a whole; expected a residue or an atom of "
                            "it (\"{0}:{1}\", \"{0}:{1} {2}\")",
                            what, atom.number, atom.atom));
        }
        Grip grip = build_grip(changed, hand, part);
        Mobility& mobility = *changed.write<Mobility>(part.molecule);
        if (is_whole) {
            mobility.motion = motion_in_hand(changed, hand);
            grip.freedom = mobility.motion == Motion::WithHandle ? 6 : 3;
            grip.pose.orientation = orientation_of(changed, part.molecule);
            set_shape(changed, part.molecule, grip.pose.orientation);
        } else if (other == Entity{}) {
            free_for_spring(mobility);
        }
        if (needs_mechanics(changed) && is_whole) grip.pose.orientation = Quat::Identity();
        changed.set(hand, std::move(grip));
        set_spring(changed, hand, part);
        begin_new_grip(changed, hand);
    });
}

}  // namespace palpa
