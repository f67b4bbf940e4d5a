// Implicit water: EEF1-SB, if the scene asks for it.
#pragma once
#include "charmm/force_field.h"
#include "charmm/solvation.h"
#include "ecs/world.h"
#include "forces/nonbonded.h"
#include "scene/description.h"

#include <optional>

namespace palpa {

// Settings of non-bonded pairs with EEF1-SB: a dielectric of 1.5 r, and a smooth end at 9 Å. For a
// scene with a solvent; in vacuum [statics] applies.
NonbondedSettings solvent_settings(const ForceFieldDescription& force_field);

// The scene's force field for its solvent: with neutral ionic groups (charmm/ionic_groups.h), or
// unchanged in vacuum.
ForceField with_solvent(const ForceFieldDescription& description, ForceField force_field);

// Sets the solvation numbers of the atoms of the table. Throws LoadError with advice if ionic
// groups are neutral in vacuum; with EEF1-SB if groups, residues or the whole are not neutral, if a
// type has no solvation numbers, or if structural waters are missing.
void set_solvation(World& world);

// Solvation of all atoms of the table; nothing in vacuum. Throws LoadError as set_solvation does
// for types without numbers.
std::optional<Solvation> find_solvation(const World& world);

}  // namespace palpa
