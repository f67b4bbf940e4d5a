// Expressions (molecule/select.h) about the atoms of a world.
#pragma once
#include "ecs/world.h"
#include "molecule/select.h"

#include <span>
#include <vector>

namespace palpa {

// Which atoms of the table are selected as they are now; `structure`, where somebody has found it,
// one entry per atom. Throws LoadError as select_atoms does.
std::vector<bool> select_in_world(const World& world, const Selection& selection,
                                  std::span<const SecondaryStructure> structure = {});

}  // namespace palpa
