// Edits change a world between two steps. An edit either succeeds completely, or throws LoadError
// with the problem and a remedy and changes nothing. If the mobile parts change, the mechanics are
// rebuilt at the present positions (rebuild_mechanics).
#pragma once
#include "ecs/world.h"
#include "scene/edits.h"

namespace palpa {

// Returns the world after an edit of any kind except undo and redo. Throws LoadError at the edit's
// place. Works on a copy, so it may run in another thread.
World make_edit(const World& world, const EditDescription& edit);

// Returns `other`, a world from before or after, as what follows on `world`: the clock continues,
// and hands grip what they hold in it at the present poses of their devices.
World continue_with(const World& world, World other);

}  // namespace palpa
