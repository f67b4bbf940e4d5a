// The syntax tree of a selection expression, made by molecule/parse_selection.cpp and evaluated by
// molecule/select.cpp.
#pragma once
#include "molecule/select.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace palpa {

// What one word stands for.
enum class AtomClass : std::uint8_t {
    All,
    None,
    Protein,
    Nucleic,
    Water,
    Ion,
    Ligand,
    Lipid,
    Glycan,
    Backbone,
    Sidechain,
    Hydrogen,
    PolarHydrogen,
    Heavy,
    Helix,
    Strand,
    Coil,
    Hand,
};

enum class NameProperty : std::uint8_t { Chain, Segment, Residue, Atom, Element, Molecule };

// A name as files spell it, or a pattern with * and ?.
struct NamePattern {
    std::string text;
    bool is_pattern = false;
    std::size_t column = 0;
};

struct NameTerm {
    NameProperty property;
    std::vector<NamePattern> names;  // any of them
};

// A residue's number with its insertion code, blank where it has none.
struct ResidueNumber {
    std::int64_t number = 0;
    char code = ' ';
};

// "27", "-3", "27A"; nothing for what is no such number.
std::optional<ResidueNumber> find_residue_number(std::string_view text);

// Both ends included.
struct NumberSpan {
    ResidueNumber first, last;
};

enum class NumberProperty : std::uint8_t { Index, Serial, ResidueNumber, Charge, Mass, X, Y, Z };

// Counts from `first` to `last`, of residues with their codes.
struct SpanTerm {
    NumberProperty property;        // one of the first three
    std::vector<NumberSpan> spans;  // any of them
};

enum class Comparison : std::uint8_t { Less, LessEqual, Greater, GreaterEqual, Equal, NotEqual };

struct CompareTerm {
    NumberProperty property;
    Comparison comparison;
    double value;
};

enum class GroupProperty : std::uint8_t { Residue, Chain, Segment, Molecule };

struct NotTerm {};
struct AndTerm {};
struct OrTerm {};
// Atoms at most `distance` (Å) from any of the child's.
struct WithinTerm {
    double distance;
    bool is_exclusive;  // without the child's atoms
};
// All atoms of every group that has one of the child's.
struct SameTerm {
    GroupProperty property;
};

struct SelectionNode {
    std::variant<AtomClass, NameTerm, SpanTerm, CompareTerm, NotTerm, AndTerm, OrTerm, WithinTerm,
                 SameTerm>
        term;
    std::size_t column = 0;               // column of the term in the text
    std::vector<SelectionNode> children;  // of and, or: two or more; of not, within, same: one
};

}  // namespace palpa
