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
    std::string text = fmt::format("{} h{} q{}", describe_bonds(graph, seen, atom), hydrogens,
                                   std::lround(12 * seen.charge[atom]));
    for (std::size_t size = 3; size <= largest_ring; ++size) {
        if (seen.in_ring_of[atom][size]) text += fmt::format(" r{}", size);
    }
    return text;
}

std::uint64_t with_neighbours(const MoleculeGraph& graph, const Perceived& seen, std::uint32_t atom,
                              std::uint64_t own, const std::vector<EnvironmentKeys>& keys,
                              Surroundings of) {
    std::vector<std::string> around;
    for (const std::uint32_t bond : seen.bonds[atom]) {
        const std::uint32_t other = other_end(graph.bonds[bond], atom);
        around.push_back(fmt::format("{}{}{:016x}", static_cast<int>(seen.kinds[bond]),
                                     seen.bond_in_ring[bond] ? 'r' : 'c',
                                     keys[other][static_cast<std::size_t>(of)]));
    }
    std::sort(around.begin(), around.end());
    return content_hash(fmt::format("{:016x} {}", own, fmt::join(around, " ")));
}

}  // namespace

std::vector<EnvironmentKeys> find_environments(const MoleculeGraph& graph, const Perceived& seen) {
    std::vector<EnvironmentKeys> keys(graph.size());
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        keys[i][0] = content_hash(graph.atoms[i].element);
        keys[i][1] = content_hash(describe_bonds(graph, seen, i));
        keys[i][2] = content_hash(describe_atom(graph, seen, i));
    }
    // Whose key each level takes of the neighbours.
    constexpr auto taken =
        std::to_array<Surroundings>({Surroundings::Bonds, Surroundings::Atom,
                                     Surroundings::OneBondAway, Surroundings::TwoBondsAway});
    for (std::size_t at = 0; at < taken.size(); ++at) {
        for (std::uint32_t i = 0; i < graph.size(); ++i) {
            keys[i][3 + at] = with_neighbours(graph, seen, i, keys[i][2], keys, taken[at]);
        }
    }
    return keys;
}

}  // namespace palpa
