#include "molecule/connectivity.h"

#include <algorithm>
#include <limits>

namespace palpa {
namespace {

constexpr std::uint32_t left_out = std::numeric_limits<std::uint32_t>::max();

template <std::size_t Count>
void append_terms(const std::vector<std::array<std::uint32_t, Count>>& from,
                  const std::vector<std::uint32_t>& new_index,
                  std::vector<std::array<std::uint32_t, Count>>& to) {
    for (std::array<std::uint32_t, Count> term : from) {
        for (std::uint32_t& atom : term) atom = new_index[atom];
        if (std::ranges::find(term, left_out) == term.end()) to.push_back(term);
    }
}

}  // namespace

std::optional<std::array<std::uint32_t, 2>> append_atoms(const Connectivity& from,
                                                         std::span<const std::uint32_t> atoms,
                                                         Connectivity& to) {
    if (to.file.empty()) to.file = from.file;
    std::vector<std::uint32_t> new_index(from.names.size(), left_out);
    for (const std::uint32_t i : atoms) {
        new_index[i] = static_cast<std::uint32_t>(to.names.size());
        to.names.push_back(from.names[i]);
        to.type.push_back(from.type[i]);
        to.charge.push_back(from.charge[i]);
        to.mass.push_back(from.mass[i]);
        to.lines.push_back(from.lines[i]);
    }
    append_terms(from.bonds, new_index, to.bonds);
    append_terms(from.angles, new_index, to.angles);
    append_terms(from.dihedrals, new_index, to.dihedrals);
    append_terms(from.impropers, new_index, to.impropers);
    append_terms(from.cmaps, new_index, to.cmaps);
    const auto leads_out = [&](const std::array<std::uint32_t, 2>& bond) {
        return (new_index[bond[0]] == left_out) != (new_index[bond[1]] == left_out);
    };
    const auto out = std::ranges::find_if(from.bonds, leads_out);
    if (out == from.bonds.end()) return std::nullopt;
    return *out;
}

std::optional<std::array<std::uint32_t, 2>> append_segment(const Connectivity& from,
                                                           std::string_view segment,
                                                           Connectivity& to) {
    std::vector<std::uint32_t> atoms;
    for (std::uint32_t i = 0; i < from.names.size(); ++i) {
        if (from.names[i].segment == segment) atoms.push_back(i);
    }
    return append_atoms(from, atoms, to);
}

}  // namespace palpa
