#include "loading/edits/changes.h"

#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/resources.h"
#include "simulation/systems/publish_contact.h"

#include <fmt/format.h>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace palpa {
namespace {

bool can_move_by_itself(const Mobility& mobility) {
    return mobility.motion == Motion::Free || mobility.shape == Shape::Flexible;
}

}  // namespace

void settle_edit(World& world) {
    rebuild_mechanics(world);
    for (const Entity hand : find_hands(world)) {
        world.write<Contact>(hand)->near = {};
        renew_contact(world, hand);
    }
}

Entity find_hand(const World& world, std::size_t hand) {
    const Entity found = hand_at(world, hand);
    if (found == Entity{})
        refuse(fmt::format("there is no {} hand; the scene has {}",
                           hand < most_hands ? edit_hand_names[hand] : "such",
                           find_hands(world).size()));
    return found;
}

Entity other_holder(const World& world, Entity hand, Entity molecule) {
    Entity other;
    world.each<Grip>([&](Entity holder, const Grip& grip) {
        if (holder == hand || grip.molecule != molecule) return;
        if (other == Entity{} || holds_whole(world, holder)) other = holder;
    });
    return other;
}

void free_for_spring(Mobility& mobility) {
    if (!can_move_by_itself(mobility)) mobility.motion = Motion::Free;
}

void release(World& world, Entity hand) {
    const Grip* const held = world.find<Grip>(hand);
    if (!held) return;
    const Grip grip = *held;
    const bool held_whole = holds_whole(world, hand);
    if (RigidShape* const shape = world.write<RigidShape>(grip.molecule);
        shape && held_whole && grip.base < 0)
        shape->orientation = grip.pose.orientation;
    world.remove<Grip>(hand);
    world.remove<Spring>(hand);
    begin_new_grip(world, hand);
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

void begin_new_grip(World& world, Entity hand) {
    ++world.write<Contact>(hand)->sent.model.grip_number;
}

void check_name_is_new(const World& world, const std::string& name) {
    if (name.empty()) refuse("the molecule has no name; expected one such as \"w2\"");
    const std::optional<Address> address = find_address(name);
    if (!address || !address->residue.empty())
        refuse(fmt::format("'{}' is not a name of a molecule; expected one without ':'", name));
    if (molecule_called(world, name) != Entity{})
        refuse(fmt::format("there is already a molecule '{}'; expected another name", name));
}

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

}  // namespace palpa
