// Finds bond orders and hydrogens of a ligand: from its own file, the entry, a monomer library, its
// hydrogens, or its positions.
#pragma once
#include "ligands/graph.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct LigandQuery {
    MoleculeGraph found;  // the residue's atoms in the structure, without bonds
    std::vector<std::filesystem::path> files;  // --ligand
    std::filesystem::path entry;               // a .cif is searched for chem_comp tables
    // Folders with a/ATP.cif in them: CCP4's monomer library.
    std::vector<std::filesystem::path> libraries;
};

struct FoundLigand {
    MoleculeGraph graph;  // with all hydrogens, named as the structure names them; positions where
                          // the structure has them
    std::string source;
    std::vector<std::string> notes;
    std::optional<std::filesystem::path> file;  // the given file that was used
};

// $CLIBD_MON if it is set, and the folder of Debian's refmac-dictionary.
std::vector<std::filesystem::path> monomer_libraries();

// The first of these that fits the residue's heavy atoms: the files, the residue's own hydrogens if
// it has some on carbon, the entry's tables, a library, the places of its atoms. A file
// with hydrogens or charges is taken at its word; otherwise acids and bases are as at pH 7.4
// (ligands/add_hydrogens.h). Atoms of the description that the structure lacks stay, without a
// position, named as there or C1X, C2X and so on. Throws LoadError for a file that cannot be read.
FoundLigand find_ligand(const LigandQuery& query);

}  // namespace palpa
