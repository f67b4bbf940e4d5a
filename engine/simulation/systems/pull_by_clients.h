#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

#include <cstddef>

namespace palpa {

// Applies the forces of clients (ClientPull) by springs of 100 Å whose ends move with the atoms, so
// that the force stays as requested. With second order, where other springs need a new model, the
// ends stay until the force is wrong by 2 %. Acts only on atoms that joints or a free base move,
// and not on a molecule that a hand holds as a whole.
void pull_by_clients(World& world, const StepInput& input);

// For the last step: whether client forces acted, and the energy of their springs, kcal/mol.
bool is_pulled_by_clients(const World& world) noexcept;
double find_client_energy(const World& world) noexcept;

// Number of atoms on which client forces have no effect now.
std::size_t count_pulls_without_effect(const World& world) noexcept;

}  // namespace palpa
