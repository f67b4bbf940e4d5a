// The user's settings for a preparation; all have defaults.
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

// How the finished system is oriented.
struct AlignSettings {
    std::string segment;  // its long axis becomes x, its centre the origin
    std::optional<std::pair<ResidueChoice, ResidueChoice>>
        up;  // y points from the first to the second
};

struct PrepareSettings {
    std::optional<int> model;  // unset: the first
    int assembly = 0;          // biological assembly to build from symmetry records; 0: none
    std::vector<std::pair<ResidueChoice, char>>
        alternates;  // location to use; default: the one with the highest occupancy
    bool keeps_waters = false;
    bool keeps_ions = true;
    // Waters that stay although waters are left out; with a solvent they are part of the structure.
    std::vector<ResidueChoice> structural_waters;
    // Residue names ("MK1"), chains ("chain:B") or residues ("A:101") that are left out.
    std::vector<std::string> without;
    // Named likewise: molecules that stay although only the crystal needed them
    // (molecule/components.h).
    std::vector<std::string> kept;

    std::vector<std::pair<std::string, std::string>> residue_names;    // "CSO" -> "CYS"
    std::vector<std::pair<ResidueChoice, std::string>> protonation;    // "HSE" or a patch, "ASPP"
    std::vector<std::pair<std::string, std::string>> first, last;      // patches at chains' ends
    std::vector<std::pair<ResidueChoice, ResidueChoice>> disulphides;  // in addition to those found
    bool finds_disulphides = true;

    // Unknown ligands get approximate residues: bonds from these files, the structure file, and
    // other sources (ligands/sources.h).
    bool approximates_ligands = false;
    std::vector<std::filesystem::path> ligand_files;
    std::filesystem::path entry;

    bool flips = true;                       // amides and imidazoles may be flipped
    std::vector<ResidueChoice> turned_over;  // those that are flipped in any case
    bool relaxes = true;
    std::optional<AlignSettings> align;

    // Phosphates of nucleic acids keep their full charge in vacuum (prepare/phosphates.h).
    bool keeps_phosphate_charges = false;

    // Solvent model; unset: EEF1-SB if it covers the whole system, else none (prepare/solvent.h).
    std::optional<Solvent> solvent = Solvent::None;
};

}  // namespace palpa
