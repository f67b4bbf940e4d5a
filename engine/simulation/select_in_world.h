// Selects atoms of a world by expressions (molecule/select.h).
#pragma once
#include "ecs/world.h"
#include "molecule/select.h"
#include "scene/description.h"

#include <span>
#include <string>
#include <vector>

namespace palpa {

// For each atom of the table, whether it is selected at its present position. `structure`: the
// secondary structure if already known, one entry per atom. Throws LoadError as select_atoms does.
std::vector<bool> select_in_world(const World& world, const Selection& selection,
                                  std::span<const SecondaryStructure> structure = {});

// The selections of [view] that select nothing. Throws LoadError with key and column for a
// malformed one, or one that names a missing molecule.
std::vector<std::string> find_empty_selections(const ViewDescription& view, const World& world);

}  // namespace palpa
