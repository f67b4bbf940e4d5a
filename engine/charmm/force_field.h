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
    std::int64_t number = -1;  // number in old topology files; -1: none
    double mass = 0;           // amu
    std::string element;       // "O"; empty if the file has none, "X": not an atom
    TextPlace place;
};

struct ResidueAtom {
    std::string name, type;
    double charge = 0;  // e
    int group = 0;      // index of its GROUP in the residue, from 0
    TextPlace place;
};

// A line of an IC table: the chain A-B-C-D, or, as an improper, C in the middle of A, B and D.
// 0 where the file leaves a value open.
struct InternalCoordinate {
    std::array<std::string, 4> atoms;  // the third name without its star
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
    std::vector<ResidueAtom> atoms;  // for a patch: new atoms, and new parameters of existing ones
    std::vector<std::array<std::string, 2>> bonds;
    std::vector<std::array<std::string, 3>> angles;     // in addition to generated ones
    std::vector<std::array<std::string, 4>> dihedrals;  // likewise
    std::vector<std::array<std::string, 4>> impropers;
    std::vector<std::array<std::string, 8>> cmaps;  // two dihedrals each
    std::vector<InternalCoordinate> internal_coordinates;
    // Of a patch: what it takes away from what residues and patches before it have.
    std::vector<std::string> deleted_atoms;
    std::vector<std::array<std::string, 2>> deleted_bonds;
    std::vector<std::array<std::string, 3>> deleted_angles;     // also of those generated
    std::vector<std::array<std::string, 4>> deleted_dihedrals;  // likewise
    std::vector<std::array<std::string, 4>> deleted_impropers;
    std::vector<std::array<std::string, 8>> deleted_cmaps;
    std::string first_patch, last_patch;  // patches at chain ends; "NONE": none
    bool has_generated_angles = true;     // false: NOANG
    bool has_generated_dihedrals = true;  // false: NODIH
    std::size_t lone_pair_line = 0;       // line of its first lone pair; 0: none
    // Every atom that bonds and other terms name, and the line where they first do.
    std::map<std::string, std::size_t, std::less<>> named_on;
    TextPlace place;
};

// One type's Lennard-Jones parameters, in CHARMM's own signs made positive.
struct NonbondedType {
    double epsilon = 0;      // kcal/mol, >= 0
    double half_rmin = 0;    // Å
    double epsilon14 = 0;    // for 1-4 pairs; as for other pairs if not given
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
    double epsilon14 = 0;  // for 1-4 pairs; as for other pairs if not given
    double rmin14 = 0;     // likewise
    TextPlace place;
};

// A note on the input that the user should know.
struct ForceFieldNote {
    enum class Kind : std::uint8_t {
        Replaced,   // defined again; `earlier` is the previous place, with other values
        Negative,   // a negative force constant
        ExtraWord,  // extra words on a line, as if a '!' were missing
        OtherFile   // another file that a stream file names
    };
    Kind kind{};
    TextPlace place;
    std::string what;  // "bond CT1 NH1", "residue HIC"
    TextPlace earlier;
};

// Sorts two types alphabetically.
std::pair<std::string, std::string> in_order(std::string a, std::string b);
std::array<std::string, 3> in_order(std::array<std::string, 3> types);
std::array<std::string, 4> in_order(std::array<std::string, 4> types);

// Names are upper case, as CHARMM reads them. Types of parameters stand `in_order`, but for CMAP,
// where the file's order counts.
struct ForceField {
    std::vector<std::string> files;  // in reading order
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

    std::vector<ForceFieldNote> notes;  // in reading order
    // For a packed force field: title, date, origin and what to cite, as lines.
    std::vector<std::string> about;
};

// Reads the files in order, later ones adding to earlier ones. What is given again replaces what
// was there, as in CHARMM, and is noted where it differs; residues and patches always. A dihedral
// or improper given again in a later part (from READ, or from its first line, to END) loses all its
// earlier multiplicities; within a part further ones join. Of two masses of a type that differ by
// less than 0.01 amu the first stays. A force constant below 0 is taken and noted, also that of a
// Urey-Bradley term, and so are words behind an ATOM line's charge.
//
// In stream files, outside of parts: SET is followed; of IF, ELSE and ENDIF the way that its
// condition says. A condition on what CHARMM alone knows (?NATC) takes a one-line IF as not true,
// and makes a block a LoadError. GOTO goes on behind the LABEL, which must come later; RETURN ends
// the file. STREAM, and READ with NAME or UNIT, are noted and not followed: other files are given
// by themselves. READ RTF and READ PARA start a part and always append. BOMLEV, WRNLEV, PRNLEV,
// IOFORMAT and ECHO are passed over, as are donors, acceptors and hydrogen bonds.
//
// Anything else is a LoadError with its line, as is a value that does not parse, an atom twice in a
// residue, a multiplicity of 0 beside others, and a file given twice. Residues with lone pairs are
// read; using one is refused. A residue, section or block that the file ends in without END is
// refused too: who knows what has been cut off. The first file may be a packed one
// (packed_force_field.h).
ForceField read_force_field(std::span<const std::filesystem::path> files);

// One line for each kind of note, with its number and the first few; empty without notes.
std::vector<std::string> describe_notes(std::span<const ForceFieldNote> notes);

// One note as text: "a.str:7: bond CT1 NH1 replaces that of b.prm:3".
std::string describe_note(const ForceFieldNote& note);

// The force field files of a folder in the order in which they are read: .rtf before .prm before
// .str, each by name, then those of the folders directly in it in the same order. Throws LoadError
// where there are none. A file is itself.
std::vector<std::filesystem::path> list_force_field_files(const std::filesystem::path& path);

// Adds the content of one file. Whether a line is topology or parameters follows from its keyword
// and, for section headers that both kinds know (BONDS, ANGLES), from what came before it in the
// file.
void parse_force_field(std::string_view text, const std::string& file, ForceField& into);

// The type of this name, or with this as its number in MASS lines; end() if there is none.
std::map<std::string, AtomType, std::less<>>::const_iterator find_type(
    const ForceField& force_field, std::string_view name);

}  // namespace palpa
