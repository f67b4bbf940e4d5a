// Renames atoms from the names of a file to those of the force field.
#pragma once
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "molecule/atoms.h"
#include "prepare/report.h"

namespace palpa {

// Renames the atoms of residues that have the force field's names, and their patches, already.
//
// Heavy atoms: by CHARMM's name, or by what the PDB and other programs call the few that differ
// (Ile CD1, OXT, water's O). Hydrogens that the template does not know by name: by the heavy atom
// that they are on; of several on one atom, in the order that agrees with the dihedral angles of
// the template's IC table, so that HB2 and HB3 become the right ones of HB1 and HB2. Hydrogens that
// a residue should not have are left out and reported. Elements in the file that contradict the
// template are put right, with a warning.
//
// Throws a LoadError with all atoms that fit nothing, all chain residues without N, CA or C, and
// all other residues that lack heavy atoms: only side chains can be built.
Structure name_atoms(const ForceField& force_field, const Structure& structure,
                     const GenerateSettings& settings, Report& report);

}  // namespace palpa
