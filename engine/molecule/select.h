// Selects atoms by expressions like those of VMD: "protein and within 5 of resname LIG". The
// language: tools/selections.md.
#pragma once
#include "molecule/atoms.h"
#include "molecule/secondary_structure.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct SelectionNode;  // molecule/selection_tree.h

// A parsed expression that can be evaluated many times; copies share it.
struct Selection {
    std::string source;  // for messages: "selection", or the origin of the expression
    std::shared_ptr<const SelectionNode> root;
};

// Throws LoadError, "SOURCE, column 9: 'protien', expected ...": columns are letters, from 1.
Selection parse_selection(std::string_view text, std::string source = "selection");

// What is measured: two, three or four expressions with ';' between them, "name CA and resid 25;
// ligand". Where one selects several atoms, the mean of their places stands for them, not weighted
// by mass. Throws the same; columns are those of the whole text.
std::vector<Selection> parse_measure(std::string_view text, const std::string& source = "measure");

// Whether other atoms may be selected once atoms have moved, which helices and strands follow, or
// hands hold others.
bool depends_on_positions(const Selection& selection);
bool depends_on_hands(const Selection& selection);

// Whether the selected atoms change only when atoms are added or removed.
bool is_constant(const Selection& selection);

struct NamedRange {
    std::string name;
    AtomRange atoms;
};

// The atoms to select from, and their data for expressions.
struct SelectionContext {
    const AtomTable& atoms;
    std::span<const NamedRange> molecules;     // none: one molecule without a name
    std::span<const std::uint32_t> hand = {};  // atoms held by hands
    // Of its residue, one entry per atom; empty where nobody has found it.
    std::span<const SecondaryStructure> structure = {};
    // One entry per atom; empty where segments name the chains: "A" or "PROA", as CHARMM-GUI
    // names them.
    std::span<const std::string> chains = {};
};

// Which atoms are selected, by number. Throws LoadError as parse_selection does, for a molecule
// that is not there, and where the secondary structure is asked for and not known.
std::vector<bool> select_atoms(const Selection& selection, const SelectionContext& context);

// One line with examples, for messages and help.
inline constexpr std::string_view selection_examples =
    "protein, chain A, resid 50:80, resname LIG, name CA or within 5 of ligand";

}  // namespace palpa
