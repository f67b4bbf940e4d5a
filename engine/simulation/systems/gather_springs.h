// Springs of the world, and the same in the mechanics (statics/springs.h).
#pragma once
#include "ecs/world.h"
#include "simulation/components.h"
#include "simulation/resources.h"
#include "simulation/systems/step_input.h"
#include "statics/springs.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace palpa {

// Gives the mechanics all springs of the world, in the order of their entities. A spring on an atom
// that the mechanics leave out does nothing.
void gather_springs(World& world, const StepInput& input);

// Moves ends of the world's springs to where the mechanics have them.
void return_ends(World& world);

// A spring with atom numbers of a model; its mechanics need not exist yet. Nothing if the model
// lacks one of the atoms.
std::optional<ModelSpring> find_model_spring(const World& world, const ModelAtoms& atoms,
                                             const Spring& spring);

// Index of the entity's spring in the mechanics; nothing if it has none there.
std::optional<std::size_t> find_spring_index(const World& world, Entity entity) noexcept;

// The entity with this component, as owner of springs; none before it was made.
template <class Owner>
Entity find_owner(const World& world) {
    Entity found;
    world.each<Owner>([&](Entity entity, const Owner&) { found = entity; });
    return found;
}
template <class Owner>
Entity make_owner(World& world) {
    Entity owner = find_owner<Owner>(world);
    if (owner == Entity{}) world.set(owner = world.create(), Owner{});
    return owner;
}

// Entities with a spring of this owner, in their order.
std::vector<Entity> find_springs(const World& world, Entity owner);

// Energy of the springs of this owner in the mechanics, kcal/mol.
double find_spring_energy(const World& world, Entity owner) noexcept;

}  // namespace palpa
