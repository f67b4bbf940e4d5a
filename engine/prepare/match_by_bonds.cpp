#include "prepare/match_by_bonds.h"

#include "molecule/element.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace palpa {
namespace {

constexpr std::uint32_t unmatched = 0xffffffff;

class BondMatcher {
public:
    BondMatcher(const BondedAtoms& given, const BondedAtoms& wanted)
        : given_(given),
          wanted_(wanted),
          match_(given.names.size(), unmatched),
          is_used_(wanted.names.size(), false) {
        find_order();
    }

    std::optional<std::vector<std::uint32_t>> find() {
        if (!has_enough() || !extend(0)) return std::nullopt;
        return match_;
    }

private:
    static constexpr std::size_t most_attempts = 200'000;

    bool has_enough() const {
        std::map<std::string_view, long> left;
        for (const std::string& element : wanted_.elements) ++left[element];
        return std::all_of(given_.elements.begin(), given_.elements.end(),
                           [&](const std::string& element) { return --left[element] >= 0; });
    }

    bool has_name(std::uint32_t atom) const {
        return std::find(wanted_.names.begin(), wanted_.names.end(), given_.names[atom]) !=
               wanted_.names.end();
    }

    // From atom to bonded atom, begun where names agree and elements are rare.
    void find_order() {
        std::map<std::string_view, std::size_t> count;
        for (const std::string& element : wanted_.elements) ++count[element];
        const auto rank = [&](std::uint32_t atom) {
            return std::pair(!has_name(atom), count[given_.elements[atom]]);
        };
        std::vector<bool> is_listed(given_.names.size(), false);
        const auto list = [&](std::uint32_t atom) {
            if (is_listed[atom]) return;
            is_listed[atom] = true;
            order_.push_back(atom);
        };
        while (order_.size() < given_.names.size()) {
            std::uint32_t first = unmatched;
            for (std::uint32_t i = 0; i < given_.names.size(); ++i) {
                if (!is_listed[i] && (first == unmatched || rank(i) < rank(first))) first = i;
            }
            std::size_t next = order_.size();
            for (list(first); next < order_.size(); ++next) {
                for (const std::uint32_t other : given_.neighbours[order_[next]]) list(other);
            }
        }
    }

    static bool are_bonded(const BondedAtoms& atoms, std::uint32_t a, std::uint32_t b) {
        const auto& others = atoms.neighbours[a];
        return std::find(others.begin(), others.end(), b) != others.end();
    }

    bool fits(std::uint32_t atom, std::uint32_t to) const {
        if (is_used_[to] || wanted_.elements[to] != given_.elements[atom]) return false;
        if (wanted_.neighbours[to].size() < given_.neighbours[atom].size()) return false;
        for (const std::uint32_t other : given_.neighbours[atom]) {
            if (match_[other] != unmatched && !are_bonded(wanted_, to, match_[other])) return false;
        }
        // What the template bonds must not be apart: a ring that would close falsely.
        return std::all_of(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(depth_),
                           [&](std::uint32_t other) {
                               return !are_bonded(wanted_, to, match_[other]) ||
                                      are_bonded(given_, atom, other);
                           });
    }

    // Those beside a matched neighbour, or all; those of the same name first.
    std::vector<std::uint32_t> find_candidates(std::uint32_t atom) const {
        std::vector<std::uint32_t> candidates;
        for (const std::uint32_t other : given_.neighbours[atom]) {
            if (match_[other] == unmatched) continue;
            candidates = wanted_.neighbours[match_[other]];
            break;
        }
        if (candidates.empty()) {
            for (std::uint32_t i = 0; i < wanted_.names.size(); ++i) candidates.push_back(i);
        }
        std::erase_if(candidates, [&](std::uint32_t to) { return !fits(atom, to); });
        std::stable_sort(
            candidates.begin(), candidates.end(),
            [&](std::uint32_t a, std::uint32_t b) { return rank(atom, a) < rank(atom, b); });
        return candidates;
    }

    std::pair<bool, std::size_t> rank(std::uint32_t atom, std::uint32_t to) const {
        const std::size_t more = wanted_.neighbours[to].size() - given_.neighbours[atom].size();
        return {wanted_.names[to] != given_.names[atom], more};
    }

    bool extend(std::size_t depth) {
        if (depth == order_.size()) return true;
        const std::uint32_t atom = order_[depth];
        depth_ = depth;
        for (const std::uint32_t to : find_candidates(atom)) {
            if (++attempts_ > most_attempts) return false;
            match_[atom] = to;
            is_used_[to] = true;
            if (extend(depth + 1)) return true;
            match_[atom] = unmatched;
            is_used_[to] = false;
            depth_ = depth;
        }
        return false;
    }

    const BondedAtoms& given_;
    const BondedAtoms& wanted_;
    std::vector<std::uint32_t> order_;  // of the given atoms
    std::vector<std::uint32_t> match_;  // by given atom
    std::vector<bool> is_used_;         // by wanted atom
    std::size_t depth_ = 0, attempts_ = 0;
};

}  // namespace

void BondedAtoms::add_bond(std::uint32_t a, std::uint32_t b) {
    if (std::find(neighbours[a].begin(), neighbours[a].end(), b) != neighbours[a].end()) return;
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
}

BondedAtoms find_bonded_atoms(const Structure& structure, const ResidueRange& residue) {
    constexpr double slack = 0.4;  // Å
    BondedAtoms atoms;
    std::vector<std::size_t> heavy;
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        std::string element = element_of(structure, i);
        if (element == "H") continue;
        heavy.push_back(i);
        atoms.names.push_back(structure.names[i].atom);
        atoms.elements.push_back(std::move(element));
    }
    atoms.neighbours.resize(heavy.size());
    for (std::uint32_t a = 0; a < heavy.size(); ++a) {
        for (std::uint32_t b = 0; b < a; ++b) {
            const double distance =
                (structure.positions[heavy[a]] - structure.positions[heavy[b]]).norm();
            const double reach =
                covalent_radius(atoms.elements[a]) + covalent_radius(atoms.elements[b]) + slack;
            if (distance < reach) atoms.add_bond(a, b);
        }
    }
    return atoms;
}

std::string element_of(const ForceField& force_field, const ResidueAtom& atom,
                       std::string_view name) {
    const auto type = find_type(force_field, atom.type);
    const bool is_stated = type != force_field.types.end() && !type->second.element.empty();
    return is_stated ? type->second.element : find_element_of_name(name, "");
}

BondedAtoms find_bonded_atoms(const ForceField& force_field, const Residue& residue) {
    BondedAtoms atoms;
    std::map<std::string_view, std::uint32_t> indices;
    for (const ResidueAtom& atom : residue.atoms) {
        std::string element = element_of(force_field, atom, atom.name);
        if (element == "H") continue;
        indices.emplace(atom.name, static_cast<std::uint32_t>(atoms.names.size()));
        atoms.names.push_back(atom.name);
        atoms.elements.push_back(std::move(element));
    }
    atoms.neighbours.resize(atoms.names.size());
    for (const auto& [a, b] : residue.bonds) {
        const auto first = indices.find(a), second = indices.find(b);
        if (first != indices.end() && second != indices.end()) {
            atoms.add_bond(first->second, second->second);
        }
    }
    return atoms;
}

std::optional<std::vector<std::uint32_t>> match_by_bonds(const BondedAtoms& given,
                                                         const BondedAtoms& wanted) {
    return BondMatcher(given, wanted).find();
}

}  // namespace palpa
