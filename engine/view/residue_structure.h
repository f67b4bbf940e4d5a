// Helices and strands of the residues of an atom table.
#pragma once
#include "molecule/atoms.h"
#include "molecule/secondary_structure.h"
#include "view/pocket.h"

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
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

// Names residues, "ASP 25", or "ASP 25 CG" of one atom; with the segment, "A:ASP 25", where another
// segment has a residue of that name and number. It refers to the table.
class ResidueNames {
public:
    ResidueNames(const AtomTable& atoms, std::span<const ResidueSpan> residues);
    std::string name(std::size_t atom, bool is_of_atom) const;

private:
    using NameAndNumber = std::pair<std::string_view, std::string_view>;

    const AtomTable& atoms_;
    std::set<NameAndNumber> shared_;  // of several segments
};

// The atom of that name, or `end` of the residue.
std::size_t find_atom(const AtomTable& atoms, const ResidueSpan& residue, std::string_view name);

}  // namespace palpa
