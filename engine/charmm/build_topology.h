// Assigns force field parameters to every term of a structure.
#pragma once
#include "charmm/force_field.h"
#include "charmm/topology.h"
#include "molecule/connectivity.h"

namespace palpa {

// By CHARMM's rules (parmfile.doc). Types may be names or the numbers of MASS lines. Of a dihedral,
// the entry of its own four types counts, read either way, else X B C X; of an improper A B C D,
// A X X D, X B C D, X B C X, X X C D, the first that there is. A dihedral that recurs (X-PLOR
// writes one for each multiplicity) counts once. One over an angle of 180 degrees, as in a nitrile,
// has no value, and needs no parameters. Terms that are nothing whatever the coordinates,
// dihedrals with k = 0 and the like, are left out; bonds stay, they exclude pairs.
//
// Every parameter that is missing is gathered, bonded and not, with one of near types, before a
// LoadError names them all.
Topology build_topology(const Connectivity& connectivity, const ForceField& force_field);

}  // namespace palpa
