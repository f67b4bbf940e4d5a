#include "molecule/selection_keywords.h"

#include "core/text.h"

#include <algorithm>
#include <array>

namespace palpa {
namespace {

using Operator = SelectionOperator;

constexpr auto selection_keywords = std::to_array<SelectionKeyword>({
    {"all", AtomClass::All},
    {"none", AtomClass::None},
    {"protein", AtomClass::Protein},
    {"nucleic", AtomClass::Nucleic},
    {"water", AtomClass::Water},
    {"waters", AtomClass::Water},
    {"ion", AtomClass::Ion},
    {"ions", AtomClass::Ion},
    {"ligand", AtomClass::Ligand},
    {"ligands", AtomClass::Ligand},
    {"lipid", AtomClass::Lipid},
    {"lipids", AtomClass::Lipid},
    {"glycan", AtomClass::Glycan},
    {"glycans", AtomClass::Glycan},
    {"backbone", AtomClass::Backbone},
    {"sidechain", AtomClass::Sidechain},
    {"hydrogen", AtomClass::Hydrogen},
    {"hydrogens", AtomClass::Hydrogen},
    {"heavy", AtomClass::Heavy},
    {"noh", AtomClass::Heavy},
    {"helix", AtomClass::Helix},
    {"strand", AtomClass::Strand},
    {"sheet", AtomClass::Strand},
    {"coil", AtomClass::Coil},
    {"hand", AtomClass::Hand},
    {"chain", NameProperty::Chain},
    {"segment", NameProperty::Segment},
    {"segid", NameProperty::Segment},
    {"segname", NameProperty::Segment},
    {"resname", NameProperty::Residue},
    {"name", NameProperty::Atom},
    {"element", NameProperty::Element},
    {"molecule", NameProperty::Molecule},
    {"index", NumberProperty::Index},
    {"serial", NumberProperty::Serial},
    {"resid", NumberProperty::ResidueNumber},
    {"residue", NumberProperty::ResidueNumber},
    {"charge", NumberProperty::Charge},
    {"mass", NumberProperty::Mass},
    {"x", NumberProperty::X},
    {"y", NumberProperty::Y},
    {"z", NumberProperty::Z},
    {"and", Operator::And},
    {"or", Operator::Or},
    {"not", Operator::Not},
    {"within", Operator::Within},
    {"exwithin", Operator::WithinOthers},
    {"of", Operator::Of},
    {"same", Operator::Same},
    {"as", Operator::As},
    {"byres", Operator::ByResidue},
    {"to", Operator::To},
    {"polar", Operator::Polar},
});

}  // namespace

const SelectionKeyword* find_selection_keyword(std::string_view lower) noexcept {
    const auto* const found = std::ranges::find(selection_keywords, lower, &SelectionKeyword::word);
    return found == selection_keywords.end() ? nullptr : found;
}

std::string near_selection_keyword(std::string_view word) {
    std::array<std::string_view, selection_keywords.size()> names;
    std::ranges::transform(selection_keywords, names.begin(), &SelectionKeyword::word);
    return near_name_hint(word, names);
}

}  // namespace palpa
