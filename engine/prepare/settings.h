// What a user may decide when a structure is prepared; everything has a default.
#pragma once
#include "scene/choices.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

// A residue as users write it, "A:25": chain (or segment) and number with its insertion code.
struct ResidueChoice {
    std::string chain;
    std::string number;
};

// How the finished system is turned.
struct AlignSettings {
    std::string segment;  // whose long axis becomes x and whose middle becomes the origin
    std::optional<std::pair<ResidueChoice, ResidueChoice>> up;  // y: from the one to the other
};

struct PrepareSettings {
    std::optional<int> model;  // none: the first
    int assembly = 0;          // biological assembly to build from symmetry records; 0: none
    std::vector<std::pair<ResidueChoice, char>> alternates;  // location to take; else by occupancy
    bool keeps_waters = false;
    bool keeps_ions = true;
    // Kept though waters be left out; with a solvent they are part of the structure.
    std::vector<ResidueChoice> structural_waters;
    // Residue names ("MK1"), chains ("chain:B") or residues ("A:101") that are left out.
    std::vector<std::string> without;
    // Likewise, kept though only the crystal needed it (molecule/components.h).
    std::vector<std::string> kept;

    std::vector<std::pair<std::string, std::string>> residue_names;    // "CSO" -> "CYS"
    std::vector<std::pair<ResidueChoice, std::string>> protonation;    // "HSE" or a patch, "ASPP"
    std::vector<std::pair<std::string, std::string>> first, last;      // patches at chains' ends
    std::vector<std::pair<ResidueChoice, ResidueChoice>> disulphides;  // beside those found
    bool finds_disulphides = true;

    // Unknown ligands get approximate residues: bonds from these files, the entry, and what else
    // there is (ligands/sources.h).
    bool approximates_ligands = false;
    std::vector<std::filesystem::path> ligand_files;
    std::filesystem::path entry;

    bool flips = true;                       // amides and imidazoles may be turned over
    std::vector<ResidueChoice> turned_over;  // those that are, whatever the search would choose
    bool relaxes = true;
    std::optional<AlignSettings> align;

    // In vacuum the phosphates of nucleic acids keep their whole charge (prepare/phosphates.h).
    bool keeps_phosphate_charges = false;

    // What stands for the water around; unset: EEF1-SB where it covers all of the system, else
    // none (prepare/solvent.h).
    std::optional<Solvent> solvent = Solvent::None;
};

}  // namespace palpa
