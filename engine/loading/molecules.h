// Creates and removes molecules of a world in its atom table.
#pragma once
#include "charmm/force_field.h"
#include "ecs/world.h"
#include "simulation/components.h"

namespace palpa {

// Creates a molecule from atoms of the table, at rest at their positions.
Entity create_molecule(World& world, Molecule molecule, Mobility mobility, Source source);

// Appends the atoms of a segment to the table, from its topology or else from the residues of the
// force field. Throws LoadError as in charmm/assign.h.
AtomRange add_segment_atoms(const ForceField& force_field, const Source& source, AtomTable& atoms);

// Sets the interactions of the atoms of the table from the scene's force field and solvent. Throws
// LoadError as set_solvation (simulation/solvent.h) does.
void set_interactions(World& world);

// Notes the present positions of its atoms as its start (StartPlaces).
void set_start_places(World& world, Entity molecule);

// Removes the molecule and its atoms; atoms behind them move up in the table. Types are numbered as
// in a table that never had them.
void remove_atoms(World& world, Entity molecule);

}  // namespace palpa
