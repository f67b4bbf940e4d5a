// Reads molecules from SDF and MOL files, version V2000 and V3000, and from MOL2 files.
#pragma once
#include "ligands/graph.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// A molecule of a file.
struct LigandFile {
    MoleculeGraph graph;          // hydrogens only if the file has them
    bool names_atoms = false;     // MOL2
    bool states_charges = false;  // whether a formal charge is not 0
    // Bonds that the file calls aromatic (or whose order it leaves open); their order is 1.
    std::vector<bool> open_bonds;
};

// The first molecule of an SDF or MOL file. Throws LoadError with file and line: counts that are
// not there, an element that is none, a bond to an atom that is not there, a position that is no
// number, a file that ends early, more than `most_ligand_atoms` atoms.
LigandFile parse_sdf(std::string_view text, const std::string& file);

// The first @<TRIPOS>MOLECULE of a MOL2 file, likewise.
LigandFile parse_mol2(std::string_view text, const std::string& file);

// Reads a file by the ending of its name: .sdf, .mol or .mol2.
LigandFile read_ligand_file(const std::filesystem::path& path);

}  // namespace palpa
