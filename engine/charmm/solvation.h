// EEF1's numbers of the atoms of a system: what each gains from water, and what others take of it.
// (T. Lazaridis, M. Karplus, Proteins 35, 133 (1999).)
#pragma once
#include <vector>

namespace palpa {

// One entry per atom; hydrogens, and what is meant to count for nothing, have no volume and no
// energies.
struct Solvation {
    std::vector<double> volume;  // V, Å^3
    std::vector<double>
        dg_ref;  // reference solvation energy of the atom in a small molecule, kcal/mol
    std::vector<double> dg_free;  // solvation energy of its shell, kcal/mol
    std::vector<double> lambda;   // thickness of its shell, Å
    std::vector<double> radius;   // R, Å
};

}  // namespace palpa
