// Helices and strands of the residues of an atom table.
#pragma once
#include "molecule/atoms.h"
#include "molecule/secondary_structure.h"
#include "view/pocket.h"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

// Those residues that have N, CA, C and O (at the end of a chain OT1, as CHARMM has it).
struct Backbone {
    std::vector<BackboneResidue> residues;
    std::vector<std::size_t> numbers;  // of each, its index among all residues
};
Backbone find_backbone(const AtomTable& atoms, std::span<const ResidueSpan> residues);

// Finds classes anew only when atoms have moved (SecondaryStructureCache).
class ResidueStructure {
public:
    // One a residue; coil where its backbone is not complete. The span lasts until the next call.
    std::span<const SecondaryStructure> update(const AtomTable& atoms,
                                               std::span<const ResidueSpan> residues);

private:
    SecondaryStructureCache cache_;
    std::vector<SecondaryStructure> structure_;
};

// One entry per atom, from one per residue; coil for atoms of no residue.
std::vector<SecondaryStructure> per_atom(const AtomTable& atoms,
                                         std::span<const ResidueSpan> residues,
                                         std::span<const SecondaryStructure> structure);

// "ASP 25", or "ASP 25 CG" of one atom; with the segment, "A:ASP 25", where another segment has a
// residue of that name and number.
std::string name_residue(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                         std::size_t atom, bool is_of_atom);

// The atom of that name, or `end` of the residue.
std::size_t find_atom(const AtomTable& atoms, const ResidueSpan& residue, std::string_view name);

}  // namespace palpa
