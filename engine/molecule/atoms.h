// The table of all atoms, an array per property, and how atoms are named.
#pragma once
#include "core/shared_vector.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// How a structure file names one atom. Molecules are found by segment.
struct AtomName {
    std::string segment;  // "WATA"
    std::string residue;  // "TIP3"
    std::string number;   // residue number, with its insertion code if there is one: "27A"
    std::string atom;     // "OH2"
};

// "WATA TIP3 1 OH2", for messages.
std::string to_string(const AtomName& name);

// Whether two atoms have the same segment, residue number and residue name.
bool is_same_residue(const AtomName& a, const AtomName& b) noexcept;

// Data of PDB and mmCIF files for an atom besides its name and position.
struct AtomRecord {
    std::int64_t serial = 0;
    std::int32_t model = 1;
    std::int32_t residue_number = 0;
    char insertion_code = ' ';
    char alternate = ' ';            // alternate location, "A"; blank if there is only one
    bool hetero = false;             // HETATM
    bool element_guessed = false;    // the file has no element
    std::int32_t formal_charge = 0;  // e
    std::string chain;
    std::string label_chain;  // the archive's chain name, label_asym_id; empty in PDB files
    std::string element;      // element as in files: "MG"
    double occupancy = 1;
    double b_factor = 0;  // Å^2
};

// A symmetry operator: x' = rotation x + translation, Å.
struct SymmetryOperator {
    std::string name;  // usually its number in the file
    Mat3 rotation;     // as in the file, possibly not a rotation
    Vec3 translation;
    std::size_t line = 0;  // first line in the file
};

// Chains of an assembly with the same operators.
struct AssemblyPart {
    // Their names, "A,B,": label_chain of the atoms, or chain where that is empty; nothing for the
    // chain without a name.
    std::string chains;
    // Indices into the operators: a copy for every choice of one out of each list. The operator of
    // the last list acts first.
    std::vector<std::vector<std::uint32_t>> operators;
};

// A biological assembly of the file's authors.
struct Assembly {
    std::string name;  // "1"
    std::vector<AssemblyPart> parts;
};

// An atom in a bond record.
struct LinkedAtom {
    std::string chain, residue, number, atom;  // number includes the insertion code
    char alternate = ' ';
};

// A bond between residues that the file states: LINK, SSBOND, struct_conn.
struct StructureLink {
    LinkedAtom a, b;
    std::size_t line = 0;
};

// Where the atoms of a structure file are, in the order of the file. All of them: models, alternate
// locations and ions as well, between which someone has yet to choose.
struct Structure {
    std::string file;
    std::vector<AtomName> names;
    std::vector<Vec3> positions;     // Å
    std::vector<std::size_t> lines;  // line of the atom in the file, for messages

    // Of CHARMM coordinate files whose weights, where prepare writes B-factors, are not all 0: one
    // an atom, Å^2. Empty for all others; files with records have them there.
    std::vector<double> weights{};

    // Of PDB and mmCIF files; empty for all others.
    std::vector<AtomRecord> records{};      // one for each atom
    std::vector<std::size_t> chain_ends{};  // number of atoms before each chain end
    std::vector<std::string> notes{};       // notes for the user, one sentence each
    // Full names of residues in the file: "TES" is "TESTOSTERONE".
    std::map<std::string, std::string> component_names{};
    // Those of the notes that say what may be wrong with the file.
    std::vector<std::string> doubts{};
    std::vector<StructureLink> links{};         // without links to symmetry copies
    std::vector<SymmetryOperator> operators{};  // operators of the assemblies
    std::vector<Assembly> assemblies{};
};

// B-factor, Å^2; 0 if the file has none.
double b_factor_of(const Structure& structure, std::size_t atom) noexcept;

// A range of an atom table.
struct AtomRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

inline bool has_atom(const AtomRange& range, std::size_t atom) noexcept {
    return atom >= range.first && atom - range.first < range.count;
}

// Solvation numbers of atoms; what one takes of another's water (EEF1, forces/solvation.h) is
//   strength volume' exp(-((r - radius)/lambda)^2)/r^2.
// One entry per atom; all empty without implicit solvent.
struct SolvationColumns {
    SharedVector<double> volume;          // Å^3
    SharedVector<double> strength;        // kcal/mol/Å
    SharedVector<double> inverse_lambda;  // 1/Å
    SharedVector<double> radius;          // Å
};

// All atoms of a world; every array up to `solvation` has one entry per atom. Written once on
// loading, but for `positions`, which each simulation step updates; copies share the rest.
struct AtomTable {
    SharedVector<AtomName> names;
    std::vector<Vec3> positions;        // Å
    SharedVector<std::string> element;  // "O"; empty if the force field has none
    SharedVector<double> mass;          // amu
    SharedVector<double> charge;        // e
    SharedVector<double> sqrt_epsilon;  // (kcal/mol)^(1/2), root of the Lennard-Jones well depth
    SharedVector<double> half_rmin;     // Å, half the distance of the well's minimum
    SharedVector<std::uint32_t> type;   // index into `type_names`
    SharedVector<double> b_factor;      // Å^2, of the structure file; 0 where it has none
    SolvationColumns solvation;

    // Bonded pairs of atoms, by index.
    SharedVector<std::array<std::uint32_t, 2>> bonds;

    SharedVector<std::string> type_names;  // types of the force field, each once

    std::size_t size() const noexcept { return names.size(); }
    // Memory, bytes; what copies share counts in equal parts.
    std::size_t count_bytes() const noexcept;
};

// In upper case: as the table has it, or as the atom's name says (molecule/element.h). Empty where
// neither has it.
std::string find_element(const AtomTable& atoms, std::size_t atom);

// Residues of a table: neighbouring atoms of one segment, number and residue name, and of one of
// the molecules, which may be called alike. Atoms of no molecule have no residue.
std::vector<AtomRange> list_residues(const AtomTable& atoms, std::span<const AtomRange> molecules);

}  // namespace palpa
