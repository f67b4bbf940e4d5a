#include "assembly/bridges.h"

#include <algorithm>
#include <numeric>

namespace palpa {

Neighbours::Neighbours(std::size_t atoms, std::span<const std::array<std::uint32_t, 2>> bonds,
                       std::span<const std::uint8_t> is_cut)
    : first_(atoms + 1, 0) {
    const auto is_left_out = [&](std::size_t bond) { return !is_cut.empty() && is_cut[bond] != 0; };
    for (std::size_t i = 0; i < bonds.size(); ++i) {
        if (is_left_out(i)) continue;
        for (const std::uint32_t atom : bonds[i]) ++first_[atom + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    entries_.resize(first_.back());
    std::vector<std::uint32_t> next = first_;
    for (std::uint32_t i = 0; i < bonds.size(); ++i) {
        if (is_left_out(i)) continue;
        const auto [a, b] = bonds[i];
        entries_[next[a]++] = {b, i};
        entries_[next[b]++] = {a, i};
    }
}

std::vector<std::uint8_t> find_bridges(const Neighbours& neighbours, std::size_t bonds) {
    struct Visit {
        std::uint32_t atom;
        std::uint32_t bond;      // by which it was reached
        std::uint32_t next = 0;  // of its neighbours
    };
    constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint8_t> is_bridge(bonds, 0);
    // When an atom was reached first, and the earliest atom that it and those below it are bonded
    // to.
    std::vector<std::uint32_t> reached(neighbours.atoms(), none), low(neighbours.atoms(), none);
    std::vector<Visit> path;
    std::uint32_t time = 0;
    for (std::uint32_t start = 0; start < neighbours.atoms(); ++start) {
        if (reached[start] != none) continue;
        reached[start] = low[start] = time++;
        path.push_back({start, none});
        while (!path.empty()) {
            Visit& visit = path.back();
            const std::uint32_t atom = visit.atom, arrival = visit.bond;
            if (visit.next < neighbours.of(atom).size()) {
                const Neighbour to = neighbours.of(atom)[visit.next++];
                if (to.bond == arrival) continue;
                if (reached[to.atom] == none) {
                    reached[to.atom] = low[to.atom] = time++;
                    path.push_back({to.atom, to.bond});
                } else {
                    low[atom] = std::min(low[atom], reached[to.atom]);
                }
                continue;
            }
            path.pop_back();
            if (path.empty()) continue;
            const std::uint32_t parent = path.back().atom;
            low[parent] = std::min(low[parent], low[atom]);
            if (low[atom] > reached[parent]) is_bridge[arrival] = 1;
        }
    }
    return is_bridge;
}

}  // namespace palpa
