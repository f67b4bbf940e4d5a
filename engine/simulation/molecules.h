// Molecules of a world in its atom table.
#pragma once
#include "charmm/force_field.h"
#include "ecs/world.h"
#include "simulation/components.h"

#include <string_view>

namespace palpa {

// Nobody where there is none.
Entity molecule_called(const World& world, std::string_view name) noexcept;

// A molecule of atoms that are in the table, at rest where it is.
Entity create_molecule(World& world, Molecule molecule, Mobility mobility, Source source);

// Appends the atoms of a segment to the table: those of its topology, or as the force field's
// residues have them. Throws LoadError as charmm/assign.h says.
AtomRange add_segment_atoms(const ForceField& force_field, const Source& source, AtomTable& atoms);

// What atoms of the table do to each other, from the scene's force field and solvent. Throws
// LoadError as set_solvation (simulation/solvent.h) does.
void set_interactions(World& world);

// A molecule moves as one piece from now on, from where it is.
void set_shape(World& world, Entity molecule);

// It starts where its atoms are now (StartPlaces).
void set_start_places(World& world, Entity molecule);

// Its atoms leave the table, and it the world; atoms behind it move up. Types are numbered as in a
// table that never had it.
void remove_atoms(World& world, Entity molecule);

}  // namespace palpa
