#include "ligands/environments.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string>

namespace palpa {
namespace {

std::string describe_bonds(const MoleculeGraph& graph, const Perceived& seen, std::uint32_t atom) {
    std::array<int, 5> kinds{};
    for (const std::uint32_t bond : seen.bonds[atom]) {
        ++kinds[static_cast<std::size_t>(seen.kinds[bond])];
    }
    return fmt::format("{} {}", graph.atoms[atom].element, fmt::join(kinds, ","));
}

std::string describe_atom(const MoleculeGraph& graph, const Perceived& seen, std::uint32_t atom) {
    const auto hydrogens = std::count_if(
        seen.bonds[atom].begin(), seen.bonds[atom].end(),
        [&](std::uint32_t bond) { return graph.is_hydrogen(other_end(graph.bonds[bond], atom)); });
    return fmt::format("{} h{}", describe_bonds(graph, seen, atom), hydrogens);
}

// Saturated rings of six atoms are as good as chains for CGenFF.
std::string describe_rings(const Perceived& seen, std::uint32_t atom, bool with_six) {
    std::string text = fmt::format(" q{}", std::lround(12 * seen.charge[atom]));
    for (std::size_t size = 3; size <= largest_ring; ++size) {
        if (size == 6 && !with_six && !seen.is_aromatic[atom]) continue;
        if (seen.in_ring_of[atom][size]) text += fmt::format(" r{}", size);
    }
    return text;
}

// Elements of the neighbours, and whether they have pi bonds.
std::string describe_neighbours(const MoleculeGraph& graph, const Perceived& seen,
                                std::uint32_t atom) {
    std::vector<std::string> around;
    for (const std::uint32_t bond : seen.bonds[atom]) {
        const std::uint32_t other = other_end(graph.bonds[bond], atom);
        const bool has_pi =
            std::any_of(seen.bonds[other].begin(), seen.bonds[other].end(),
                        [&](std::uint32_t of) { return seen.kinds[of] != BondKind::Single; });
        const char* const kind = seen.is_aromatic[other] ? "a" : has_pi ? "p" : "s";
        around.push_back(fmt::format("{}{}{}", graph.atoms[other].element, kind,
                                     static_cast<int>(seen.kinds[bond])));
    }
    std::sort(around.begin(), around.end());
    return fmt::format(" {}", fmt::join(around, " "));
}

std::uint64_t with_neighbours(const MoleculeGraph& graph, const Perceived& seen, std::uint32_t atom,
                              std::uint64_t own, const std::vector<std::uint64_t>& of) {
    std::vector<std::string> around;
    for (const std::uint32_t bond : seen.bonds[atom]) {
        const std::uint32_t other = other_end(graph.bonds[bond], atom);
        around.push_back(fmt::format("{}{}{:016x}", static_cast<int>(seen.kinds[bond]),
                                     seen.bond_in_ring[bond] ? 'r' : 'c', of[other]));
    }
    std::sort(around.begin(), around.end());
    return content_hash(fmt::format("{:016x} {}", own, fmt::join(around, " ")));
}

}  // namespace

std::vector<EnvironmentKeys> find_environments(const MoleculeGraph& graph, const Perceived& seen) {
    std::vector<EnvironmentKeys> keys(graph.size());
    std::vector<std::uint64_t> bonds, own;
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        const std::string kinds =
            describe_atom(graph, seen, i) + describe_neighbours(graph, seen, i);
        keys[i][0] = content_hash(graph.atoms[i].element);
        keys[i][1] = content_hash(describe_bonds(graph, seen, i));
        keys[i][2] = content_hash(kinds);
        keys[i][3] = content_hash(kinds + describe_rings(seen, i, false));
        bonds.push_back(keys[i][1]);
        own.push_back(content_hash(describe_atom(graph, seen, i) + describe_rings(seen, i, true)));
    }
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        keys[i][4] = with_neighbours(graph, seen, i, own[i], bonds);
    }
    // Each level takes what the one before it says of the neighbours.
    std::vector<std::uint64_t> around = own;
    for (std::size_t level = 5; level < surroundings_levels; ++level) {
        for (std::uint32_t i = 0; i < graph.size(); ++i) {
            keys[i][level] = with_neighbours(graph, seen, i, own[i], around);
        }
        for (std::uint32_t i = 0; i < graph.size(); ++i) around[i] = keys[i][level];
    }
    return keys;
}

}  // namespace palpa
