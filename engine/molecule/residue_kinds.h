// Classifies residues: protein, nucleic acid, water and so on.
#pragma once
#include "molecule/atoms.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

// Each residue is of one kind.
enum class ResidueKind : std::uint8_t {
    Water,
    Ion,      // a single metal or halogen atom
    Protein,  // including caps
    Nucleic,  // free nucleotides are ligands
    Glycan,   // bound or free sugars
    Lipid,
    Ligand,  // everything else
};

// Whether the residue name is water, in the PDB, CHARMM or other programs.
bool is_water(std::string_view residue) noexcept;

// Whether it is one of the 20 amino acids in any protonation, or a cap.
bool is_plain_amino_acid(std::string_view residue) noexcept;

// Of each residue, a range of the table. By its atoms where these decide: a water is an oxygen with
// two hydrogens, an amino acid has N, CA and C, a nucleotide a ribose and a bond to the next
// nucleotide. Else by its name: of the PDB (molecule/components.h) and of CHARMM36.
std::vector<ResidueKind> find_residue_kinds(const AtomTable& atoms,
                                            std::span<const AtomRange> residues);

// The names of backbone atoms: N, CA, C and O of an amino acid with what ends a chain; of a
// nucleotide its phosphate and the carbons and oxygens up to the next one. Hydrogens have none.
bool is_of_backbone(ResidueKind kind, std::string_view atom) noexcept;

}  // namespace palpa
