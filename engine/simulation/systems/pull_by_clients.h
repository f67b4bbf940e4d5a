#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

#include <cstddef>

namespace palpa {

// Pulls what clients pull (ClientPull) by springs of 100 Å, whose ends run before the atoms: so the
// force stays what it was asked to be. By second order, where other springs need another model,
// ends stay until the force is wrong by 2 %. Only atoms that joints or a free base move are pulled,
// and none of a molecule that a hand holds as a whole: that goes where the hand goes.
void pull_by_clients(World& world, const StepInput& input);

// Of the last step: whether clients pulled at something, and the energy of these springs, kcal/mol.
bool is_pulled_by_clients(const World& world) noexcept;
double find_client_energy(const World& world) noexcept;

// Atoms on which forces of clients do nothing now.
std::size_t count_pulls_without_effect(const World& world) noexcept;

}  // namespace palpa
