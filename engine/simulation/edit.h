// Edits change a world between two steps. An edit either succeeds completely, or throws LoadError
// with the problem and a remedy and changes nothing. If the mobile parts change, the mechanics are
// rebuilt at the present positions (rebuild_mechanics).
#pragma once
#include "ecs/world.h"
#include "scene/edits.h"

namespace palpa {

// The edits of scene/edits.h, with a hand where they need one. The hand first releases what it
// held. A molecule held as a whole follows the hand; at a spring it moves by itself, even if it is
// otherwise fixed. On release it gets back its former mobility.
void take(World& world, Entity hand, const TakeEdit& edit);
void let_go(World& world, Entity hand);
// Refused where something else is there now, and where another hand holds it too.
void put_back(World& world, Entity hand);
void add_molecule(World& world, const AddEdit& edit);
void remove_molecule(World& world, const RemoveEdit& edit);
void pin(World& world, const PinEdit& edit);
void add_restraint(World& world, const RestraintEdit& edit);
void set_mobility(World& world, const MobilityEdit& edit);
void set_appearance(World& world, const AppearanceEdit& edit);
void set_coupling(World& world, const CouplingEdit& edit);
// Loads the scene again; the clock continues, and hands grip at the present poses of their devices.
void reset(World& world);

// Returns the world after an edit of any kind except undo and redo. Throws LoadError at the edit's
// place. Works on a copy, so it may run in another thread.
World make_edit(const World& world, const EditDescription& edit);

// Returns `other`, a world from before or after, as what follows on `world`: the clock continues,
// and hands grip what they hold in it at the present poses of their devices.
World continue_with(const World& world, World other);

}  // namespace palpa
