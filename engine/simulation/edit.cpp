#include "simulation/edit.h"

#include "charmm/force_field.h"
#include "scene/read_scene.h"
#include "simulation/coupling.h"
#include "simulation/held.h"
#include "simulation/load.h"
#include "simulation/mechanics.h"
#include "simulation/molecules.h"
#include "simulation/named_parts.h"
#include "simulation/playback.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/sources.h"
#include "simulation/systems/publish_contact.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// ---- names of molecules -----------------------------------------------------------------------

void check_name_is_new(const World& world, const std::string& name) {
    if (name.empty()) refuse("the new molecule has no name; expected a name such as name = \"w2\"");
    const std::optional<Address> address = find_address(name);
    if (!address || !address->residue.empty())
        refuse(fmt::format("'{}' is not a name of a molecule; expected one without ':'", name));
    if (molecule_called(world, name) != Entity{})
        refuse(fmt::format("there is already a molecule '{}'; expected another name", name));
}

// ---- after an edit ---------------------------------------------------------------------------

void refresh_contact(World& world, Entity hand) {
    Contact& contact = *world.write<Contact>(hand);
    const std::uint32_t start = contact.answer.model.start;
    contact.near = {};
    if (world.find<Grip>(hand)) {
        update_near(world, hand);
        contact.answer = build_local_contact(world, hand, {});
    } else {
        contact.answer = build_still_contact(world);
    }
    contact.answer.model.start = start;
}

// Mechanics and contact models from where everything is.
void settle_edit(World& world) {
    rebuild_mechanics(world);
    for (const Entity hand : find_hands(world)) refresh_contact(world, hand);
}

// Another start: the servo puts the molecule where the model says.
void take_hold_anew(World& world, Entity hand) { ++world.write<Contact>(hand)->answer.model.start; }

// What another world, which takes this one's place, goes on with: what hands hold there they take
// hold of anew, where their devices are.
void keep_clock_and_devices(const World& world, World& other) {
    world.each<Hand>([&](Entity entity, const Hand& hand) {
        if (Hand* const held = other.write<Hand>(entity)) *held = hand;
        const Contact* const now = world.find<Contact>(entity);
        Contact* const then = other.write<Contact>(entity);
        if (now && then) then->answer.model.start = now->answer.model.start + 1;
    });
    other.write<Clock>() = world.resource<Clock>();
    carry_playback(world, other);
    carry_engine(world, other);
}

// Changes a copy, which takes the world's place only if all went well.
template <class Change>
void edit_whole(World& world, const Change& change) {
    World changed = world;
    change(changed);
    settle_edit(changed);
    world = std::move(changed);
}

// ---- hold --------------------------------------------------------------------------------------

Entity other_holder(const World& world, Entity hand, Entity molecule) {
    Entity other;
    world.each<Grip>([&](Entity holder, const Grip& grip) {
        if (holder != hand && grip.molecule == molecule) other = holder;
    });
    return other;
}

bool can_move_by_itself(const Mobility& mobility) {
    return mobility.motion == Motion::Free || mobility.shape == Shape::Flexible;
}

// A spring needs a molecule that can move.
void free_for_spring(Mobility& mobility) {
    if (!can_move_by_itself(mobility)) mobility.motion = Motion::Free;
}

void release(World& world, Entity hand) {
    const Grip* const held = world.find<Grip>(hand);
    if (!held) return;
    const Grip grip = *held;
    const bool held_whole = holds_whole(world, hand);
    world.remove<Grip>(hand);
    world.remove<Spring>(hand);
    take_hold_anew(world, hand);
    const Entity other = other_holder(world, hand, grip.molecule);
    Mobility& mobility = *world.write<Mobility>(grip.molecule);
    if (other == Entity{}) {
        mobility = grip.before;
        return;
    }
    if (!held_whole) return;
    mobility = grip.before;
    free_for_spring(mobility);
}

Motion motion_in_hand(const World& world, Entity hand) {
    if (needs_mechanics(world)) return Motion::TranslateAndTurn;
    return world.find<Hand>(hand)->turns ? Motion::WithHandle : Motion::Translate;
}

// From what the hand measured before, or from the molecule itself.
Entity find_origin(const World& world, Entity molecule) {
    const Entity origin = molecule_called(world, world.resource<GrabSettings>().measured_from);
    return origin == Entity{} ? molecule : origin;
}

// Adds the hand's spring where `what` are atoms, as stiff as the scene has it.
void set_spring(World& world, Entity hand, const AtomsOf& what) {
    if (what.atoms.empty()) return;
    hold_by_spring(world, hand, what, world.resource<GrabSettings>().spring_kcal_per_mol_angstrom2);
}

Grip build_grip(const World& world, const AtomsOf& what) {
    Grip grip;
    grip.molecule = what.molecule;
    // What it may do while nobody holds it.
    const Entity other = other_holder(world, {}, what.molecule);
    grip.before =
        other == Entity{} ? *world.find<Mobility>(what.molecule) : grip_of(world, other).before;
    grip.measured_from = find_origin(world, what.molecule);
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    const Molecule& origin = *world.find<Molecule>(grip.measured_from);
    const Molecule& molecule = *world.find<Molecule>(what.molecule);
    grip.anchor = positions[origin.reference_atom];
    const bool is_whole = what.atoms.empty();
    const Vec3 place = is_whole ? positions[molecule.reference_atom] : middle_of(world, what);
    grip.pose.place_angstrom = place - grip.anchor;
    grip.line_origin = grip.pose.place_angstrom;
    grip.projector = Mat3::Identity();
    grip.freedom = 3;
    grip.is_new = false;
    return grip;
}

// ---- molecules ---------------------------------------------------------------------------------

Source build_source(const World& world, Entity original, const AddEdit& edit) {
    if (original != Entity{}) return copy_source(world, original, edit.name);
    if (!edit.structure.empty())
        return read_segment(edit.structure, edit.topology, edit.segment, edit.name);
    return build_residue(*world.resource<ForceFieldInUse>().force_field, edit.residue, edit.name);
}

void place_atoms(World& world, AtomRange range, const Vec3& by) {
    std::vector<Vec3>& positions = world.write<AtomTable>().positions;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) positions[i] += by;
}

// Nothing that is not bonded comes as near, and from there forces would tear molecules apart.
// `remedy`: what would be right.
void check_room(const AtomTable& atoms, AtomRange added, const std::string& name,
                const std::string& remedy) {
    constexpr double nearest = 1;  // Å
    std::array<std::size_t, 2> pair{};
    double closest2 = nearest * nearest;
    for (std::uint32_t i = added.first; i < added.first + added.count; ++i) {
        for (std::uint32_t j = 0; j < atoms.positions.size(); ++j) {
            if (has_atom(added, j)) continue;
            const double distance2 = (atoms.positions[i] - atoms.positions[j]).squaredNorm();
            if (!(distance2 < closest2)) continue;
            closest2 = distance2;
            pair = {i, j};
        }
    }
    if (pair[0] == pair[1]) return;
    refuse(
        fmt::format("'{}' would overlap another molecule: {} is {:.2f} Å from {}; expected {} with "
                    "at least {} Å between all atoms",
                    name, to_string(atoms.names[pair[0]]), std::sqrt(closest2),
                    to_string(atoms.names[pair[1]]), remedy, nearest));
}

void forget_bonded_terms(World& world) { world.set_resource(BondedTerms{}); }

bool names(std::span<const AtomsOf> atoms, Entity molecule) {
    return std::ranges::find(atoms, molecule, &AtomsOf::molecule) != atoms.end();
}

// What names a molecule that goes.
void forget(World& world, Entity molecule) {
    std::vector<Entity> gone;
    world.each<Spring>([&](Entity entity, const Spring& spring) {
        if (names(spring.ends, molecule)) gone.push_back(entity);
    });
    world.each<Mark>([&](Entity entity, const Mark& mark) {
        if (names(mark.atoms, molecule)) gone.push_back(entity);
    });
    for (const Entity entity : gone) world.destroy(entity);
    world.write_each<Grip>([&](Entity, Grip& grip) {
        if (grip.measured_from == molecule) grip.measured_from = grip.molecule;
    });
}

}  // namespace

void take(World& world, Entity hand, const TakeEdit& edit) {
    edit_whole(world, [&](World& changed) {
        AtomsOf what = find_atoms(changed, edit.what);
        release(changed, hand);
        // A remote engine's atoms are held by springs alone.
        if (!places_atoms(changed)) {
            if (what.atoms.empty()) what.atoms = all_atoms_of(changed, what.molecule);
            changed.set(hand, build_grip(changed, what));
            set_spring(changed, hand, what);
            take_hold_anew(changed, hand);
            return;
        }
        const bool is_whole = what.atoms.empty();
        const Entity other = other_holder(changed, hand, what.molecule);
        if (is_whole && other != Entity{} && holds_whole(changed, other)) {
            refuse(
                fmt::format("the other hand holds '{}' as a whole; expected a residue or an "
                            "atom of it, as \"{}:25 CA\"",
                            edit.what, edit.what));
        }
        Grip grip = build_grip(changed, what);
        Mobility& mobility = *changed.write<Mobility>(what.molecule);
        if (is_whole) {
            mobility.motion = motion_in_hand(changed, hand);
            grip.freedom = mobility.motion == Motion::WithHandle ? 6 : 3;
            grip.pose.orientation = changed.find<Pose>(what.molecule)->orientation;
            set_shape(changed, what.molecule);
        } else if (other == Entity{}) {
            free_for_spring(mobility);
        }
        if (needs_mechanics(changed) && is_whole) grip.pose.orientation = Quat::Identity();
        changed.set(hand, std::move(grip));
        set_spring(changed, hand, what);
        take_hold_anew(changed, hand);
    });
}

void let_go(World& world, Entity hand) {
    edit_whole(world, [&](World& changed) { release(changed, hand); });
}

void put_back(World& world, Entity hand) {
    edit_whole(world, [&](World& changed) {
        Grip* const grip = changed.write<Grip>(hand);
        if (!grip)
            refuse("the hand holds nothing that could go back; expected one that holds some");
        const Molecule& molecule = *changed.find<Molecule>(grip->molecule);
        if (other_holder(changed, hand, grip->molecule) != Entity{}) {
            refuse(fmt::format("the other hand holds '{}' too; expected it to let go first",
                               molecule.name));
        }
        AtomTable& atoms = changed.write<AtomTable>();
        std::ranges::copy(*changed.find<StartPlaces>(grip->molecule)->atoms,
                          atoms.positions.begin() + molecule.atoms.first);
        check_room(atoms, molecule.atoms, molecule.name, "room where it was at the start");
        const Vec3 place = holds_whole(changed, hand)
                               ? atoms.positions[molecule.reference_atom]
                               : middle_of(changed, held_part_of(changed, hand));
        grip->pose = {place - grip->anchor, Quat::Identity()};
        *changed.write<Pose>(grip->molecule) = {atoms.positions[molecule.reference_atom],
                                                Quat::Identity()};
        if (changed.find<RigidShape>(grip->molecule)) set_shape(changed, grip->molecule);
        take_hold_anew(changed, hand);
    });
}

void add_molecule(World& world, const AddEdit& edit) {
    edit_whole(world, [&](World& changed) {
        check_name_is_new(changed, edit.name);
        const ForceField& force_field = *changed.resource<ForceFieldInUse>().force_field;
        const bool is_copy = !edit.copy_of.empty();
        const Entity original = is_copy ? find_molecule(changed, edit.copy_of) : Entity{};
        Source source = build_source(changed, original, edit);
        AtomTable& atoms = changed.write<AtomTable>();
        const AtomRange range = add_segment_atoms(force_field, source, atoms);
        std::uint32_t reference = range.first;
        Mobility mobility{needs_mechanics(changed) ? Motion::Free : Motion::Fixed, Shape::Rigid};
        if (is_copy) {
            const Molecule& of = *changed.find<Molecule>(original);
            reference += of.reference_atom - of.atoms.first;
            mobility.shape = changed.find<Mobility>(original)->shape;
        }
        const Vec3 at(edit.at_angstrom.data());
        place_atoms(changed, range, at - atoms.positions[reference]);
        check_room(atoms, range, edit.name, "a place (at_angstrom)");
        set_start_places(changed, create_molecule(changed, {edit.name, range, reference}, mobility,
                                                  std::move(source)));
        set_interactions(changed);
        forget_bonded_terms(changed);
    });
}

void remove_molecule(World& world, const RemoveEdit& edit) {
    edit_whole(world, [&](World& changed) {
        const Entity molecule = find_molecule(changed, edit.molecule);
        std::size_t count = 0;
        changed.each<Molecule>([&](Entity, const Molecule&) { ++count; });
        if (count == 1)
            refuse(fmt::format("'{}' is the last molecule and cannot be removed", edit.molecule));
        for (const Entity hand : find_hands(changed)) {
            const Grip* const grip = changed.find<Grip>(hand);
            if (grip && grip->molecule == molecule) release(changed, hand);
        }
        forget(changed, molecule);
        remove_atoms(changed, molecule);
        set_interactions(changed);
        forget_bonded_terms(changed);
    });
}

void pin(World& world, const PinEdit& edit) { world.set(world.create(), build_mark(world, edit)); }

void add_restraint(World& world, const RestraintEdit& edit) {
    edit_whole(world, [&](World& changed) {
        changed.set(changed.create(), build_spring(changed, edit));
        if (!needs_mechanics(changed))
            refuse(
                "a restraint has no effect, because no molecule moves by itself; expected a "
                "molecule with motion = \"free\" or shape = \"flexible\"");
    });
}

void set_mobility(World& world, const MobilityEdit& edit) {
    if (edit.motion && *edit.motion != Motion::Fixed && *edit.motion != Motion::Free)
        refuse(
            "this motion needs a hand that holds the molecule; expected motion = \"fixed\" or "
            "\"free\"");
    edit_whole(world, [&](World& changed) {
        const Entity molecule = find_molecule(changed, edit.molecule);
        bool is_held = false;
        changed.write_each<Grip>([&](Entity, Grip& grip) {
            if (grip.molecule != molecule) return;
            is_held = true;
            if (edit.motion) grip.before.motion = *edit.motion;
            if (edit.shape) grip.before.shape = *edit.shape;
        });
        Mobility& mobility = *changed.write<Mobility>(molecule);
        if (edit.motion && !is_held) mobility.motion = *edit.motion;
        if (edit.shape) mobility.shape = *edit.shape;
    });
}

void set_appearance(World& world, const AppearanceEdit& edit) {
    const Entity molecule = find_molecule(world, edit.molecule);
    Appearance appearance;
    if (const Appearance* const before = world.find<Appearance>(molecule)) appearance = *before;
    if (edit.representation) appearance.representation = edit.representation;
    if (edit.colouring) appearance.colouring = edit.colouring;
    if (edit.visible) appearance.visible = *edit.visible;
    world.set(molecule, appearance);
}

void set_coupling(World& world, const CouplingEdit& edit) {
    const CouplingDescription coupling =
        with_settings(world.resource<Coupling>().description, edit.settings);
    if (!can_build_laws(coupling))
        refuse(
            "eq. 2 with these F_h1_N, F_h2_N and F_0_nN cannot have the slopes A_f_max at 0 and "
            "A_f_min at F_0; expected other values, or force_law = \"printed\"");
    set_coupling(coupling, world);
}

void reset(World& world) {
    world = continue_with(world, load_again(world));
    ++world.write<Clock>().resets;
}

namespace {

Entity hand_at(const World& world, std::size_t slot) {
    const std::vector<Entity> hands = find_hands(world);
    if (slot >= hands.size())
        refuse(fmt::format("there is no {} hand; the scene has {}", slot == 1 ? "second" : "such",
                           hands.size()));
    return hands[slot];
}

// What a remote engine moves can be held and looked at.
void check_engine_allows(const World& world, const EditDescription& edit) {
    const EditAction& action = edit.action;
    if (places_atoms(world) || std::holds_alternative<TakeEdit>(action) ||
        std::holds_alternative<LetGoEdit>(action) ||
        std::holds_alternative<AppearanceEdit>(action) ||
        std::holds_alternative<CouplingEdit>(action))
        return;
    refuse(
        fmt::format("a remote engine moves the atoms of this scene, so '{}' is not possible; "
                    "expected take, let_go, appearance or coupling",
                    edit_names[action.index()]));
}

// Each edit and the function above that makes it.
void make(World& world, const EditDescription& edit) {
    check_engine_allows(world, edit);
    const auto visit = [&](const auto& action) {
        using Action = std::decay_t<decltype(action)>;
        if constexpr (std::is_same_v<Action, TakeEdit>)
            take(world, hand_at(world, edit.hand), action);
        else if constexpr (std::is_same_v<Action, LetGoEdit>)
            let_go(world, hand_at(world, edit.hand));
        else if constexpr (std::is_same_v<Action, PutBackEdit>)
            put_back(world, hand_at(world, edit.hand));
        else if constexpr (std::is_same_v<Action, AddEdit>)
            add_molecule(world, action);
        else if constexpr (std::is_same_v<Action, RemoveEdit>)
            remove_molecule(world, action);
        else if constexpr (std::is_same_v<Action, PinEdit>)
            pin(world, action);
        else if constexpr (std::is_same_v<Action, RestraintEdit>)
            add_restraint(world, action);
        else if constexpr (std::is_same_v<Action, MobilityEdit>)
            set_mobility(world, action);
        else if constexpr (std::is_same_v<Action, AppearanceEdit>)
            set_appearance(world, action);
        else if constexpr (std::is_same_v<Action, CouplingEdit>)
            set_coupling(world, action);
        else if constexpr (std::is_same_v<Action, ResetEdit>)
            reset(world);
        else
            static_assert(std::is_same_v<Action, UndoEdit> || std::is_same_v<Action, RedoEdit>);
    };
    std::visit(visit, edit.action);
}

}  // namespace

World make_edit(const World& world, const EditDescription& edit) {
    World changed = world;
    name_place(edit.place, [&] { make(changed, edit); });
    return changed;
}

World continue_with(const World& world, World other) {
    keep_clock_and_devices(world, other);
    restore_caches(other);
    return other;
}

}  // namespace palpa
