// Measures the similarity of two CGenFF types by the atoms that have them in the force field's
// residues.
#pragma once
#include "ligands/model_compounds.h"

#include <map>
#include <span>
#include <string>

namespace palpa {

// Means over all atoms of a type.
struct TypeTraits {
    std::string element;
    double bonds = 0;       // number of bonds
    double hydrogens = 0;   // bonds to hydrogens
    double pi = 0;          // 1 with a double bond, 2 with a triple one or two doubles
    double aromatic = 0;    // share of aromatic atoms
    double small_ring = 0;  // share in rings of 3 or 4 atoms
    double five_ring = 0, six_ring = 0;
    double charge = 0;  // formal, e
    int atoms = 0;
};

class TypeDistances {
public:
    explicit TypeDistances(std::span<const ModelCompound> compounds);

    // 0 for one type; 1 to 30 within an element; more for others; `unlike` for hydrogen and another
    // element, and for types that no residue has.
    static constexpr double unlike = 1000;
    double between(const std::string& a, const std::string& b) const;

private:
    std::map<std::string, TypeTraits> traits_;
};

}  // namespace palpa
