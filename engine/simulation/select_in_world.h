// Expressions (molecule/select.h) about the atoms of a world.
#pragma once
#include "ecs/world.h"
#include "molecule/select.h"
#include "scene/description.h"

#include <span>
#include <string>
#include <vector>

namespace palpa {

// Which atoms of the table are selected as they are now; `structure`, where somebody has found it,
// one entry per atom. Throws LoadError as select_atoms does.
std::vector<bool> select_in_world(const World& world, const Selection& selection,
                                  std::span<const SecondaryStructure> structure = {});

// The selections of [view] that select nothing. Throws LoadError, with the key and the column, for
// one that is none, or names a molecule that is not there.
std::vector<std::string> find_empty_selections(const ViewDescription& view, const World& world);

}  // namespace palpa
