// The residues of a structure, as ranges of its atoms.
#pragma once
#include "molecule/atoms.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct ResidueRange {
    std::size_t first = 0, count = 0;  // atoms

    std::size_t end() const noexcept { return first + count; }
};

// Neighbouring atoms of one model, chain, segment, number and residue name are a residue; those
// that differ in the residue's name alone too, as long as each has an alternate location.
std::vector<ResidueRange> find_residues(const Structure& structure);

// The atom's chain, or its segment if the file has no chains.
const std::string& chain_of(const Structure& structure, std::size_t atom);

// "PRO A 1", the name of a residue in messages.
std::string residue_label(const Structure& structure, const ResidueRange& residue);

std::optional<std::size_t> find_atom(const Structure& structure, const ResidueRange& residue,
                                     std::string_view name);

// The atoms with `kept` set, everything that goes with them, and where chains end.
Structure keep_atoms(const Structure& structure, const std::vector<bool>& kept);

void rename_residue(Structure& structure, const ResidueRange& residue, std::string_view name);

// The atoms in another order. `end_of`: where a chain that ended behind an atom ends now, as a
// number of atoms.
Structure with_order(const Structure& structure, std::span<const std::size_t> order,
                     std::span<const std::size_t> end_of);

// The hydrogens of a residue that are nearer to this atom of it than to its other heavy atoms, and
// within 1.5 Å.
std::vector<std::size_t> hydrogens_on(const Structure& structure, const ResidueRange& residue,
                                      std::size_t heavy);

// The element of an atom; guessed from its name if the file has none.
std::string element_of(const Structure& structure, std::size_t atom);

}  // namespace palpa
