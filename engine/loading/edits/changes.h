// Changes of a world that several edits make.
#pragma once
#include "ecs/world.h"
#include "loading/named_parts.h"
#include "simulation/components.h"

#include <cstddef>
#include <string>
#include <utility>

namespace palpa {

// Rebuilds the solver and the contact models from where everything is.
void settle_edit(World& world);

// Changes a copy, which takes the world's place only if all went well.
template <class Change>
void edit_whole(World& world, const Change& change) {
    World changed = world;
    change(changed);
    settle_edit(changed);
    world = std::move(changed);
}

// The hand of this number, from 0. Refuses one that the world does not have.
Entity find_hand(const World& world, std::size_t hand);

// Another hand that holds the molecule, the one that holds it as a whole first; none without one.
Entity other_holder(const World& world, Entity hand, Entity molecule);

// Makes a molecule mobile that a spring is to move.
void free_for_spring(Mobility& mobility);

// The hand releases what it holds, which gets back its mobility.
void release(World& world, Entity hand);

// Increments the grip number, so that the servo resets its pose from the model.
void begin_new_grip(World& world, Entity hand);

// Refuses a name that a molecule has, and one that no address could have.
void check_name_is_new(const World& world, const std::string& name);

// Refuses a place where other molecules are: nothing that is not bonded comes as near, and from
// there forces would tear molecules apart. `remedy`: what would be right.
void check_room(const AtomTable& atoms, AtomRange added, const std::string& name,
                const std::string& remedy);

}  // namespace palpa
