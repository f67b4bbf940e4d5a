// CHARMM topology (.rtf), parameter (.prm) and stream (.str) files: atom types, residues, patches,
// and the numbers of every term of the force field.
#pragma once
#include "core/load_error.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
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
    std::string element;       // "O"; empty where the file names none, "X": no atom at all
    TextPlace place;
};

struct ResidueAtom {
    std::string name, type;
    double charge = 0;  // e
    int group = 0;      // which GROUP of the residue it stands in, from 0
    TextPlace place;
};

// A line of an IC table: the chain A-B-C-D, or, as an improper, C in the middle of A, B and D.
// 0 where the file leaves a value open.
struct InternalCoordinate {
    std::array<std::string, 4> atoms;  // the third without its star
    bool is_improper = false;          // the third had a star
    double first_bond = 0;             // Å, A-B; A-C of an improper
    double first_angle_deg = 0;        // A-B-C; A-C-B of an improper
    double dihedral_deg = 0;           // A-B-C-D
    double last_angle_deg = 0;         // B-C-D
    double last_bond = 0;              // Å, C-D
};

// A residue (RESI) or a patch (PRES). Everything names atoms as the file does: '+' and '-' before a
// name mean the next and the previous residue of the chain, a digit before a name of a patch means
// the residue that it is given in that place ("2SG").
struct Residue {
    double charge = 0;               // e, as the RESI or PRES line states it
    std::vector<ResidueAtom> atoms;  // of a patch: new ones, and new numbers for those there
    std::vector<std::array<std::string, 2>> bonds;
    std::vector<std::array<std::string, 3>> angles;     // given beside those generated
    std::vector<std::array<std::string, 4>> dihedrals;  // likewise
    std::vector<std::array<std::string, 4>> impropers;
    std::vector<std::array<std::string, 8>> cmaps;  // two dihedrals each
    std::vector<InternalCoordinate> internal_coordinates;
    std::vector<std::string> deleted_atoms;                     // of a patch
    std::vector<std::array<std::string, 4>> deleted_impropers;  // of a patch
    std::string first_patch, last_patch;  // at the ends of a chain; "NONE": none
    bool has_generated_angles = true;     // false: NOANG
    bool has_generated_dihedrals = true;  // false: NODIH
    std::size_t lone_pair_line = 0;       // of its first lone pair; 0: it has none
    // Every atom that bonds and other terms name, and the line where they first do.
    std::map<std::string, std::size_t, std::less<>> named_on;
    TextPlace place;
};

// One type's Lennard-Jones parameters, in CHARMM's own signs made positive.
struct NonbondedType {
    double epsilon = 0;      // kcal/mol, >= 0
    double half_rmin = 0;    // Å
    double epsilon14 = 0;    // of atoms three bonds apart; the plain ones where none are given
    double half_rmin14 = 0;  // likewise
    TextPlace place;
};

struct HarmonicParameter {
    double k = 0;      // kcal/mol/Å^2; E = k (x - x0)^2
    double value = 0;  // Å
    TextPlace place;
};

struct AngleParameter {
    double k = 0;                // kcal/mol/rad^2; E = k (x - x0)^2
    double value = 0;            // degree
    double urey_bradley_k = 0;   // kcal/mol/Å^2; 0: none
    double urey_bradley_s0 = 0;  // Å
    TextPlace place;
};

// One multiplicity of a dihedral or improper, E = k (1 + cos(n x - phase)); with n = 0,
// E = k (x - phase)^2.
struct DihedralTerm {
    double k = 0;          // kcal/mol, or kcal/mol/rad^2
    int multiplicity = 0;  // n
    double phase_deg = 0;
    TextPlace place;
};

struct CmapParameter {
    std::vector<double> energies;  // kcal/mol, a square, as build_cmap_map takes them
    TextPlace place;
};

// A pair of types' Lennard-Jones numbers in place of the combination rule.
struct NbfixPair {
    double epsilon = 0;    // kcal/mol, >= 0
    double rmin = 0;       // Å
    double epsilon14 = 0;  // of atoms three bonds apart; the plain ones where none are given
    double rmin14 = 0;     // likewise
    TextPlace place;
};

// Of the two ways to read types, the lower in the alphabet.
std::pair<std::string, std::string> in_order(std::string a, std::string b);
std::array<std::string, 3> in_order(std::array<std::string, 3> types);
std::array<std::string, 4> in_order(std::array<std::string, 4> types);

// Names are upper case, as CHARMM reads them. Types of parameters stand `in_order`, but for CMAP,
// where the file's order counts.
struct ForceField {
    std::vector<std::string> files;  // in the order in which they were read
    std::map<std::string, AtomType, std::less<>> types;
    std::map<std::string, Residue, std::less<>> residues;
    std::map<std::string, Residue, std::less<>> patches;
    bool generates_angles = false;     // AUTO ANGLES
    bool generates_dihedrals = false;  // AUTO DIHEDRALS

    std::map<std::string, NonbondedType, std::less<>> nonbonded;
    std::map<std::pair<std::string, std::string>, HarmonicParameter> bonds;
    std::map<std::array<std::string, 3>, AngleParameter> angles;
    // "X" stands for any type: X B C X in dihedrals; A X X D, X B C D, X B C X, X X C D in
    // impropers. An entry holds each multiplicity once.
    std::map<std::array<std::string, 4>, std::vector<DihedralTerm>> dihedrals;
    std::map<std::array<std::string, 4>, std::vector<DihedralTerm>> impropers;
    std::map<std::array<std::string, 8>, CmapParameter> cmaps;
    std::map<std::pair<std::string, std::string>, NbfixPair> nbfix;
};

// Reads the files in order, later ones adding to earlier ones. In a stream file the script lines
// that toppar files carry (set, if, read) are understood; donors, acceptors and hydrogen bonds are
// passed over knowingly. Anything else is a LoadError with its line, as is a value that does not
// parse, a name given twice with different values, and a file given twice. Residues with lone pairs
// are read; using one is refused. A residue or section that the file ends in without END is refused
// too: who knows what has been cut off.
ForceField read_force_field(std::span<const std::filesystem::path> files);

// Adds the content of one file. Whether a line is topology or parameters follows from its keyword
// and, for section headers that both kinds know (BONDS, ANGLES), from what came before it in the
// file.
void parse_force_field(std::string_view text, const std::string& file, ForceField& into);

// The type of this name, or with this as its number in MASS lines; end() if there is none.
std::map<std::string, AtomType, std::less<>>::const_iterator find_type(
    const ForceField& force_field, std::string_view name);

}  // namespace palpa
