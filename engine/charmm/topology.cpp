#include "charmm/topology.h"

#include "core/assertion.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace palpa {

LennardJonesTable build_lennard_jones_table(std::span<const LennardJonesType> types,
                                            std::span<const Nbfix> nbfix) {
    const std::size_t n = types.size();
    LennardJonesTable table{n, {}};
    table.pairs.reserve(n * n);
    for (const LennardJonesType& a : types) {
        for (const LennardJonesType& b : types) {
            table.pairs.push_back({std::sqrt(a.epsilon * b.epsilon), a.half_rmin + b.half_rmin});
        }
    }
    for (const Nbfix& fix : nbfix) {
        PALPA_ASSERT(fix.a < n && fix.b < n);
        table.pairs[fix.a * n + fix.b] = fix.pair;
        table.pairs[fix.b * n + fix.a] = fix.pair;
    }
    return table;
}

Exclusions build_exclusions(std::span<const Bond> bonds, std::size_t atom_count) {
    std::vector<std::vector<std::uint32_t>> bonded(atom_count);
    for (const Bond& bond : bonds) {
        PALPA_ASSERT(bond.a < atom_count && bond.b < atom_count);
        bonded[bond.a].push_back(bond.b);
        bonded[bond.b].push_back(bond.a);
    }

    Exclusions exclusions;
    exclusions.first.push_back(0);
    for (std::uint32_t atom = 0; atom < atom_count; ++atom) {
        // Outwards from the atom, a shell per bond.
        std::set<std::uint32_t> reached{atom}, shell{atom};
        for (int distance = 1; distance <= 3; ++distance) {
            std::set<std::uint32_t> next;
            for (const std::uint32_t from : shell) {
                for (const std::uint32_t to : bonded[from]) {
                    if (reached.insert(to).second) next.insert(to);
                }
            }
            shell.swap(next);
        }
        const auto above = reached.upper_bound(atom);
        exclusions.atoms.insert(exclusions.atoms.end(), above, reached.end());
        exclusions.first.push_back(static_cast<std::uint32_t>(exclusions.atoms.size()));
        std::for_each(shell.upper_bound(atom), shell.end(),
                      [&](std::uint32_t other) { exclusions.pairs14.push_back({atom, other}); });
    }
    return exclusions;
}

}  // namespace palpa
