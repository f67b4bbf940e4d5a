// The secondary structure of the residues of an atom table.
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

// The residues with N, CA, C and O (OT1 at the end of a chain, as in CHARMM).
struct Backbone {
    std::vector<BackboneResidue> residues;
    std::vector<std::size_t> numbers;  // index of each among all residues
};
Backbone find_backbone(const AtomTable& atoms, std::span<const ResidueSpan> residues);

// Computes the classes again only when atoms have moved (SecondaryStructureCache).
class ResidueStructure {
public:
    // One entry per residue; coil if its backbone is not complete. The span is valid until the next
    // call.
    std::span<const SecondaryStructure> update(const AtomTable& atoms,
                                               std::span<const ResidueSpan> residues);

private:
    SecondaryStructureCache cache_;
    std::vector<SecondaryStructure> structure_;
};

// One entry per atom from one entry per residue; coil for atoms of no residue.
std::vector<SecondaryStructure> per_atom(const AtomTable& atoms,
                                         std::span<const ResidueSpan> residues,
                                         std::span<const SecondaryStructure> structure);

// Names residues, "ASP 25", or atoms, "ASP 25 CG"; with the segment, "A:ASP 25", if another segment
// has the same residue name and number. Refers to the table.
class ResidueNames {
public:
    ResidueNames(const AtomTable& atoms, std::span<const ResidueSpan> residues);
    std::string name(std::size_t atom, bool is_of_atom) const;

private:
    using NameAndNumber = std::pair<std::string_view, std::string_view>;

    const AtomTable& atoms_;
    std::set<NameAndNumber> shared_;  // names that occur in several segments
};

// The atom with this name, or `end` of the residue.
std::size_t find_atom(const AtomTable& atoms, const ResidueSpan& residue, std::string_view name);

}  // namespace palpa
