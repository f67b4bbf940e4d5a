#include "molecule/select.h"

#include "core/text.h"
#include "molecule/element.h"
#include "molecule/point_grid.h"
#include "molecule/residue_kinds.h"
#include "molecule/selection_match.h"
#include "molecule/selection_tree.h"
#include "molecule/selection_words.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

namespace palpa {
namespace {

using Atoms = std::vector<bool>;

// What several words ask for, found once.
class Evaluation {
public:
    Evaluation(const SelectionContext& context, std::string_view source)
        : context_(context), atoms_(context.atoms), source_(source) {
        for (const NamedRange& molecule : context.molecules) ranges_.push_back(molecule.atoms);
        if (ranges_.empty()) ranges_.push_back({0, static_cast<std::uint32_t>(atoms_.size())});
    }

    Atoms select(const SelectionNode& node) {
        return std::visit([&](const auto& term) { return select(term, node); }, node.term);
    }

private:
    template <class Test>
    Atoms select_where(const Test& test) const {
        Atoms chosen(atoms_.size(), false);
        for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = test(i);
        return chosen;
    }

    template <class Test>
    Atoms select_residues_where(const Test& test) {
        Atoms chosen(atoms_.size(), false);
        for (std::size_t i = 0; i < residues().size(); ++i)
            if (test(i)) std::fill_n(at(chosen, residues()[i].first), residues()[i].count, true);
        return chosen;
    }

    static Atoms::iterator at(Atoms& chosen, std::size_t atom) {
        return chosen.begin() + static_cast<std::ptrdiff_t>(atom);
    }

    // ---- words

    Atoms select(AtomClass which, const SelectionNode& node) {
        switch (which) {
            case AtomClass::All:
                return Atoms(atoms_.size(), true);
            case AtomClass::None:
                return Atoms(atoms_.size(), false);
            case AtomClass::Protein:
                return select_kind(ResidueKind::Protein);
            case AtomClass::Nucleic:
                return select_kind(ResidueKind::Nucleic);
            case AtomClass::Water:
                return select_kind(ResidueKind::Water);
            case AtomClass::Ion:
                return select_kind(ResidueKind::Ion);
            case AtomClass::Ligand:
                return select_kind(ResidueKind::Ligand);
            case AtomClass::Lipid:
                return select_kind(ResidueKind::Lipid);
            case AtomClass::Glycan:
                return select_kind(ResidueKind::Glycan);
            case AtomClass::Backbone:
                return select_backbone(true);
            case AtomClass::Sidechain:
                return select_backbone(false);
            case AtomClass::Hydrogen:
                return select_where([&](std::size_t i) { return is_hydrogen(i); });
            case AtomClass::PolarHydrogen:
                return select_polar();
            case AtomClass::Heavy:
                return select_where([&](std::size_t i) { return is_heavy(i); });
            case AtomClass::Helix:
                return select_structure(is_helix, node);
            case AtomClass::Strand:
                return select_structure(
                    [](SecondaryStructure of) { return of == SecondaryStructure::Strand; }, node);
            case AtomClass::Coil:
                return select_structure(
                    [](SecondaryStructure of) {
                        return !is_helix(of) && of != SecondaryStructure::Strand;
                    },
                    node);
            case AtomClass::Hand:
                break;
        }
        Atoms chosen(atoms_.size(), false);
        for (const std::uint32_t atom : context_.hand) chosen[atom] = true;
        return chosen;
    }

    Atoms select_kind(ResidueKind kind) {
        return select_residues_where([&](std::size_t i) { return kinds()[i] == kind; });
    }

    // Or the side chains of proteins. Hydrogens go with the atom that they are bonded to.
    Atoms select_backbone(bool is_backbone) {
        Atoms chosen(atoms_.size(), false);
        for (std::size_t i = 0; i < residues().size(); ++i) {
            const ResidueKind kind = kinds()[i];
            if (!is_backbone && kind != ResidueKind::Protein) continue;
            for (std::uint32_t k = 0; k < residues()[i].count; ++k) {
                const std::uint32_t atom = residues()[i].first + k;
                const std::string& name = atoms_.names[carriers()[atom]].atom;
                chosen[atom] = is_of_backbone(kind, name) == is_backbone;
            }
        }
        return chosen;
    }

    Atoms select_polar() {
        return select_where([&](std::size_t i) {
            if (!is_hydrogen(i) || carriers()[i] == i) return false;
            return is_polar(find_element(atoms_, carriers()[i]));
        });
    }

    template <class IsOf>
    Atoms select_structure(const IsOf& is_of, const SelectionNode& node) {
        if (context_.structure.empty())
            refuse_selection(source_, node.column,
                             "the secondary structure is unknown here, expected an expression "
                             "without helix, strand and coil");
        Atoms chosen = select_kind(ResidueKind::Protein);
        for (std::size_t i = 0; i < chosen.size(); ++i)
            chosen[i] = chosen[i] && is_of(context_.structure[i]);
        return chosen;
    }

    // ---- names and numbers

    Atoms select(const NameTerm& term, const SelectionNode& /*node*/) const {
        const auto any = [&](std::string_view text) { return fits_any(term.names, text); };
        switch (term.property) {
            case NameProperty::Chain:
                return select_where([&](std::size_t i) {
                    const std::string_view segment = atoms_.names[i].segment;
                    if (!context_.chains.empty()) return any(context_.chains[i]);
                    return any(segment) || any(chain_in(segment));
                });
            case NameProperty::Segment:
                return select_where([&](std::size_t i) { return any(atoms_.names[i].segment); });
            case NameProperty::Residue:
                return select_where([&](std::size_t i) { return any(atoms_.names[i].residue); });
            case NameProperty::Atom:
                return select_where([&](std::size_t i) { return any(atoms_.names[i].atom); });
            case NameProperty::Element:
                return select_where([&](std::size_t i) { return any(find_element(atoms_, i)); });
            case NameProperty::Molecule:
                break;
        }
        return select_molecules(term.names);
    }

    Atoms select_molecules(std::span<const NamePattern> names) const {
        Atoms chosen(atoms_.size(), false);
        for (const NamePattern& name : names) {
            bool is_there = false;
            for (const NamedRange& molecule : context_.molecules) {
                if (!fits(name, molecule.name)) continue;
                is_there = true;
                std::fill_n(at(chosen, molecule.atoms.first), molecule.atoms.count, true);
            }
            if (!is_there) refuse_molecule(name);
        }
        return chosen;
    }

    [[noreturn]] void refuse_molecule(const NamePattern& name) const {
        const auto& molecules = context_.molecules;
        if (molecules.empty())
            refuse_selection(source_, name.column,
                             fmt::format("no molecule '{}', expected none where molecules have no "
                                         "names",
                                         name.text));
        std::vector<std::string_view> known;
        for (const NamedRange& molecule : molecules) known.emplace_back(molecule.name);
        constexpr std::size_t most_listed = 8;
        std::string list;
        for (std::size_t i = 0; i < known.size() && i < most_listed; ++i)
            list += fmt::format("{}{}", i == 0 ? "" : ", ", known[i]);
        if (known.size() > most_listed) list += ", ...";
        refuse_selection(source_, name.column,
                         fmt::format("no molecule '{}', expected one of {}{}", name.text, list,
                                     near_name_hint(name.text, known)));
    }

    Atoms select(const SpanTerm& term, const SelectionNode& /*node*/) {
        const auto any = [&](const ResidueNumber& value) {
            return std::ranges::any_of(term.spans,
                                       [&](const NumberSpan& span) { return is_in(span, value); });
        };
        if (term.property == NumberProperty::ResidueNumber) {
            return select_residues_where([&](std::size_t i) {
                const auto number = number_of(i);
                return number && any(*number);
            });
        }
        const std::int64_t base = term.property == NumberProperty::Serial ? 1 : 0;
        return select_where(
            [&](std::size_t i) { return any({static_cast<std::int64_t>(i) + base, ' '}); });
    }

    Atoms select(const CompareTerm& term, const SelectionNode& /*node*/) {
        const auto compare = [&](const auto& value_of) {
            return select_where(
                [&](std::size_t i) { return holds(term.comparison, value_of(i), term.value); });
        };
        const auto coordinate = [&](Eigen::Index axis) {
            return compare([&, axis](std::size_t i) { return atoms_.positions[i][axis]; });
        };
        switch (term.property) {
            case NumberProperty::Index:
                return compare([](std::size_t i) { return static_cast<double>(i); });
            case NumberProperty::Serial:
                return compare([](std::size_t i) { return static_cast<double>(i + 1); });
            case NumberProperty::Charge:
                return compare([&](std::size_t i) { return atoms_.charge[i]; });
            case NumberProperty::Mass:
                return compare([&](std::size_t i) { return atoms_.mass[i]; });
            case NumberProperty::X:
                return coordinate(0);
            case NumberProperty::Y:
                return coordinate(1);
            case NumberProperty::Z:
                return coordinate(2);
            case NumberProperty::ResidueNumber:
                break;
        }
        return select_residues_where([&](std::size_t i) {
            const auto number = number_of(i);
            return number &&
                   holds(term.comparison, static_cast<double>(number->number), term.value);
        });
    }

    // ---- of other expressions

    Atoms select(NotTerm /*term*/, const SelectionNode& node) {
        Atoms chosen = select(node.children[0]);
        chosen.flip();
        return chosen;
    }

    Atoms select(AndTerm /*term*/, const SelectionNode& node) {
        return join(node, [](bool a, bool b) { return a && b; });
    }

    Atoms select(OrTerm /*term*/, const SelectionNode& node) {
        return join(node, [](bool a, bool b) { return a || b; });
    }

    template <class Join>
    Atoms join(const SelectionNode& node, const Join& joined) {
        Atoms chosen = select(node.children[0]);
        for (std::size_t child = 1; child < node.children.size(); ++child) {
            const Atoms other = select(node.children[child]);
            for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = joined(chosen[i], other[i]);
        }
        return chosen;
    }

    Atoms select(const WithinTerm& term, const SelectionNode& node) {
        const Atoms of = select(node.children[0]);
        std::vector<Vec3> places;
        for (std::size_t i = 0; i < of.size(); ++i)
            if (of[i]) places.push_back(atoms_.positions[i]);
        constexpr double smallest_edge = 2;  // Å
        const PointGrid grid(std::move(places), std::max(smallest_edge, term.distance / 2));
        return select_where([&](std::size_t i) {
            return of[i] ? !term.is_exclusive : grid.has_near(atoms_.positions[i], term.distance);
        });
    }

    Atoms select(const SameTerm& term, const SelectionNode& node) {
        const Atoms of = select(node.children[0]);
        const std::vector<std::uint32_t> groups = list_groups(term.property);
        Atoms is_meant(atoms_.size() + 1, false);  // there are no more groups than atoms
        for (std::size_t i = 0; i < of.size(); ++i)
            if (of[i]) is_meant[groups[i]] = true;
        return select_where([&](std::size_t i) { return is_meant[groups[i]]; });
    }

    // Each atom's group; those of no group, together, the last number.
    std::vector<std::uint32_t> list_groups(GroupProperty property) {
        std::vector<std::uint32_t> groups(atoms_.size(), static_cast<std::uint32_t>(atoms_.size()));
        const auto number = [&](std::span<const AtomRange> ranges) {
            for (std::uint32_t i = 0; i < ranges.size(); ++i)
                std::fill_n(groups.begin() + ranges[i].first, ranges[i].count, i);
        };
        if (property == GroupProperty::Residue) number(residues());
        if (property == GroupProperty::Molecule) number(ranges_);
        if (property == GroupProperty::Residue || property == GroupProperty::Molecule)
            return groups;
        std::map<std::string_view, std::uint32_t> known;
        for (std::size_t i = 0; i < groups.size(); ++i) {
            std::string_view name = atoms_.names[i].segment;
            if (property == GroupProperty::Chain)
                name = context_.chains.empty() ? chain_in(name) : context_.chains[i];
            groups[i] =
                known.try_emplace(name, static_cast<std::uint32_t>(known.size())).first->second;
        }
        return groups;
    }

    // ---- of atoms and residues

    const std::vector<AtomRange>& residues() {
        if (!residues_) residues_ = list_residues(atoms_, ranges_);
        return *residues_;
    }

    const std::vector<ResidueKind>& kinds() {
        if (!kinds_) kinds_ = find_residue_kinds(atoms_, residues());
        return *kinds_;
    }

    std::optional<ResidueNumber> number_of(std::size_t residue) {
        return find_residue_number(atoms_.names[residues()[residue].first].number);
    }

    bool is_hydrogen(std::size_t atom) const {
        const std::string element = find_element(atoms_, atom);
        return element == "H" || element == "D";
    }

    // Neither are lone pairs and the like, which have hardly any mass.
    bool is_heavy(std::size_t atom) const {
        constexpr double lightest = 0.9;  // amu
        return !is_hydrogen(atom) && atoms_.mass[atom] > lightest;
    }

    // Of a hydrogen what it is bonded to, of all others themselves.
    const std::vector<std::uint32_t>& carriers() {
        if (carriers_) return *carriers_;
        carriers_.emplace(atoms_.size());
        for (std::uint32_t i = 0; i < atoms_.size(); ++i) (*carriers_)[i] = i;
        for (const auto& [a, b] : atoms_.bonds) {
            const bool first = is_hydrogen(a), second = is_hydrogen(b);
            if (first && !second) (*carriers_)[a] = b;
            if (second && !first) (*carriers_)[b] = a;
        }
        return *carriers_;
    }

    const SelectionContext& context_;
    const AtomTable& atoms_;
    std::string_view source_;
    std::vector<AtomRange> ranges_;  // of the molecules
    std::optional<std::vector<AtomRange>> residues_;
    std::optional<std::vector<ResidueKind>> kinds_;
    std::optional<std::vector<std::uint32_t>> carriers_;
};

template <class Test>
bool has_term(const SelectionNode& node, const Test& test) {
    return test(node) || std::ranges::any_of(node.children, [&](const SelectionNode& child) {
               return has_term(child, test);
           });
}

}  // namespace

bool depends_on_positions(const Selection& selection) {
    return has_term(*selection.root, [](const SelectionNode& node) {
        const auto* const word = std::get_if<AtomClass>(&node.term);
        const auto* const compare = std::get_if<CompareTerm>(&node.term);
        const bool is_structure = word && (*word == AtomClass::Helix ||
                                           *word == AtomClass::Strand || *word == AtomClass::Coil);
        return is_structure || std::holds_alternative<WithinTerm>(node.term) ||
               (compare && compare->property >= NumberProperty::X);
    });
}

bool depends_on_hands(const Selection& selection) {
    return has_term(*selection.root, [](const SelectionNode& node) {
        const auto* const word = std::get_if<AtomClass>(&node.term);
        return word && *word == AtomClass::Hand;
    });
}

bool is_constant(const Selection& selection) {
    return !depends_on_positions(selection) && !depends_on_hands(selection);
}

std::vector<bool> select_atoms(const Selection& selection, const SelectionContext& context) {
    return Evaluation(context, selection.source).select(*selection.root);
}

}  // namespace palpa
