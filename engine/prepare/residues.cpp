#include "prepare/residues.h"

#include "molecule/element.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {
namespace {

bool is_same_residue(const Structure& structure, std::size_t a, std::size_t b) {
    const AtomName& one = structure.names[a];
    const AtomName& other = structure.names[b];
    if (one.segment != other.segment || one.number != other.number) return false;
    if (structure.records.empty()) return one.residue == other.residue;
    const AtomRecord& first = structure.records[a];
    const AtomRecord& second = structure.records[b];
    if (first.model != second.model || first.chain != second.chain) return false;
    return one.residue == other.residue || (first.alternate != ' ' && second.alternate != ' ');
}

}  // namespace

std::vector<ResidueRange> find_residues(const Structure& structure) {
    std::vector<ResidueRange> residues;
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        const bool is_end =
            std::binary_search(structure.chain_ends.begin(), structure.chain_ends.end(), i);
        if (i == 0 || is_end || !is_same_residue(structure, i - 1, i)) {
            residues.push_back({i, 0});
        }
        ++residues.back().count;
    }
    return residues;
}

const std::string& chain_of(const Structure& structure, std::size_t atom) {
    if (structure.records.empty() || structure.records[atom].chain.empty()) {
        return structure.names[atom].segment;
    }
    return structure.records[atom].chain;
}

std::string residue_label(const Structure& structure, const ResidueRange& residue) {
    const AtomName& name = structure.names[residue.first];
    const std::string& chain = chain_of(structure, residue.first);
    return chain.empty() ? fmt::format("{} {}", name.residue, name.number)
                         : fmt::format("{} {} {}", name.residue, chain, name.number);
}

std::optional<std::size_t> find_atom(const Structure& structure, const ResidueRange& residue,
                                     std::string_view name) {
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        if (structure.names[i].atom == name) return i;
    }
    return std::nullopt;
}

Structure keep_atoms(const Structure& structure, const std::vector<bool>& kept) {
    Structure result;
    result.file = structure.file;
    result.notes = structure.notes;
    result.doubts = structure.doubts;
    result.component_names = structure.component_names;
    result.links = structure.links;
    result.operators = structure.operators;
    result.assemblies = structure.assemblies;
    std::size_t end = 0;
    const auto close_chains = [&](std::size_t before) {
        for (; end < structure.chain_ends.size() && structure.chain_ends[end] <= before; ++end) {
            const std::size_t count = result.names.size();
            const bool is_new = result.chain_ends.empty() || result.chain_ends.back() != count;
            if (count > 0 && is_new) result.chain_ends.push_back(count);
        }
    };
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        close_chains(i);
        if (!kept[i]) continue;
        result.names.push_back(structure.names[i]);
        result.positions.push_back(structure.positions[i]);
        result.lines.push_back(structure.lines[i]);
        if (!structure.records.empty()) result.records.push_back(structure.records[i]);
    }
    close_chains(structure.names.size());
    return result;
}

void rename_residue(Structure& structure, const ResidueRange& residue, std::string_view name) {
    for (std::size_t i = residue.first; i < residue.end(); ++i) structure.names[i].residue = name;
}

Structure with_order(const Structure& structure, std::span<const std::size_t> order,
                     std::span<const std::size_t> end_of) {
    Structure result = structure;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::size_t from = order[i];
        result.names[i] = structure.names[from];
        result.positions[i] = structure.positions[from];
        result.lines[i] = structure.lines[from];
        if (!structure.records.empty()) result.records[i] = structure.records[from];
    }
    result.chain_ends.clear();
    for (const std::size_t end : structure.chain_ends) {
        const std::size_t now = end_of[end - 1];
        const bool is_new = result.chain_ends.empty() || result.chain_ends.back() < now;
        if (is_new && now > 0) result.chain_ends.push_back(now);
    }
    return result;
}

std::vector<std::size_t> hydrogens_on(const Structure& structure, const ResidueRange& residue,
                                      std::size_t heavy) {
    constexpr double longest_bond = 1.5;  // Å; S-H is 1.33
    std::vector<std::size_t> hydrogens;
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        if (element_of(structure, i) != "H") continue;
        std::size_t nearest = i;
        double distance = longest_bond;
        for (std::size_t j = residue.first; j < residue.end(); ++j) {
            if (element_of(structure, j) == "H") continue;
            const double d = (structure.positions[i] - structure.positions[j]).norm();
            if (d < distance) {
                distance = d;
                nearest = j;
            }
        }
        if (nearest == heavy) hydrogens.push_back(i);
    }
    return hydrogens;
}

std::string element_of(const Structure& structure, std::size_t atom) {
    if (!structure.records.empty() && !structure.records[atom].element.empty()) {
        const std::string& element = structure.records[atom].element;
        return element == "D" ? "H" : element;
    }
    return find_element_of_name(structure.names[atom].atom, structure.names[atom].residue);
}

}  // namespace palpa
