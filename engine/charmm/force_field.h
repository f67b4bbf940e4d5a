// CHARMM topology (.rtf), parameter (.prm) and stream (.str) files, as far as rigid molecules
// need them: atom types, residues' atoms and charges, non-bonded parameters, bond and angle values.
#pragma once
#include "core/load_error.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {

struct AtomType {
    std::int64_t number = -1;  // by which old topologies call it; -1: none
    double mass = 0;           // amu
    std::string element;       // "O"; empty where the file names none
    TextPlace place;
};

struct ResidueAtom {
    std::string name, type;
    double charge = 0;  // e
    TextPlace place;
};

struct Residue {
    double charge = 0;  // e, as the RESI line states it
    std::vector<ResidueAtom> atoms;
    std::vector<std::array<std::string, 2>> bonds;  // by atom name; a name may begin with + or -
    TextPlace place;
};

// One type's Lennard-Jones parameters, in CHARMM's own signs made positive.
struct NonbondedType {
    double epsilon = 0;    // kcal/mol, >= 0
    double half_rmin = 0;  // Å
    TextPlace place;
};

struct HarmonicParameter {
    double k = 0;      // kcal/mol/Å^2 or kcal/mol/rad^2; E = k (x - x0)^2
    double value = 0;  // Å or degree
    TextPlace place;
};

// A pair of types' Lennard-Jones numbers in place of the combination rule.
struct NbfixPair {
    double epsilon = 0;  // kcal/mol, >= 0
    double rmin = 0;     // Å
    TextPlace place;
};

// Names are upper case, as CHARMM reads them.
struct ForceField {
    std::vector<std::string> files;  // in the order in which they were read
    std::map<std::string, AtomType, std::less<>> types;
    std::map<std::string, Residue, std::less<>> residues;
    std::map<std::string, NonbondedType, std::less<>> nonbonded;
    std::map<std::pair<std::string, std::string>, HarmonicParameter> bonds;  // either order
    std::map<std::array<std::string, 3>, HarmonicParameter> angles;          // either order
    std::map<std::pair<std::string, std::string>, NbfixPair> nbfix;          // either order
};

// Reads the files in order, later ones adding to earlier ones. In a stream file the script lines
// that toppar files carry (set, if, read) are understood; torsions, impropers, CMAP, patches and
// internal coordinates are passed over knowingly: rigid molecules have no use for them. Anything
// else is a LoadError with its line, as is a value that does not parse or a name given twice with
// different values.
ForceField read_force_field(std::span<const std::filesystem::path> files);

// Adds the content of one file. Whether a line is topology or parameters follows from its keyword
// and, for section headers that both kinds know (BONDS, ANGLES), from what came before it in the
// file.
void parse_force_field(std::string_view text, const std::string& file, ForceField& into);

}  // namespace palpa
