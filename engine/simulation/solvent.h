// The water around the molecules that is not there as molecules: EEF1-SB, where a scene says so.
#pragma once
#include "charmm/force_field.h"
#include "charmm/solvation.h"
#include "ecs/world.h"
#include "forces/nonbonded.h"
#include "scene/description.h"

#include <optional>

namespace palpa {

// How pairs act with EEF1-SB: a dielectric of 1.5 r, and what ends at 9 Å. For a scene with a
// solvent; in vacuum pairs act as [statics] says.
NonbondedSettings solvent_settings(const ForceFieldDescription& force_field);

// The scene's force field, as its solvent needs it: with neutral ionic groups
// (charmm/ionic_groups.h), or in vacuum as it is.
ForceField with_solvent(const ForceFieldDescription& description, ForceField force_field);

// Gives the atoms of the table the numbers of the scene's solvent. Throws LoadError with what to do
// where ionic groups are neutral in vacuum; or, with EEF1-SB, where groups, residues or the whole
// are not, where a type has no numbers, and where structural waters are none.
void set_solvation(World& world);

// Of all atoms of the table; nothing in vacuum. Throws LoadError as set_solvation does for types
// without numbers.
std::optional<Solvation> find_solvation(const World& world);

}  // namespace palpa
