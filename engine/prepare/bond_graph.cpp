#include "prepare/bond_graph.h"

#include <numbers>
#include <numeric>

namespace palpa {

Lists::Lists(std::span<const std::array<std::uint32_t, 2>> entries, std::size_t atoms)
    : first_(atoms + 1, 0), numbers_(entries.size()) {
    for (const auto& [atom, number] : entries) ++first_[atom + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next = first_;
    for (const auto& [atom, number] : entries) numbers_[next[atom]++] = number;
}

BondGraph::BondGraph(const Connectivity& connectivity, const Topology& topology)
    : mass_(connectivity.mass), topology_(&topology) {
    std::vector<std::array<std::uint32_t, 2>> neighbours, bonds, angles;
    for (std::uint32_t i = 0; i < topology.bonds.size(); ++i) {
        const Bond& bond = topology.bonds[i];
        if (is_hydrogen(bond.a) && is_hydrogen(bond.b)) continue;
        neighbours.push_back({bond.a, bond.b});
        neighbours.push_back({bond.b, bond.a});
        bonds.push_back({bond.a, i});
        bonds.push_back({bond.b, i});
    }
    for (std::uint32_t i = 0; i < topology.angles.size(); ++i) {
        angles.push_back({topology.angles[i].b, i});
    }
    neighbours_ = Lists(neighbours, topology.size());
    bonds_ = Lists(bonds, topology.size());
    angles_ = Lists(angles, topology.size());
}

double BondGraph::bond_length(std::uint32_t a, std::uint32_t b) const noexcept {
    for (const std::uint32_t i : bonds_.of(a)) {
        const Bond& bond = topology_->bonds[i];
        if (bond.a == b || bond.b == b) return bond.r0;
    }
    return 0;
}

std::optional<double> BondGraph::find_angle(std::uint32_t a, std::uint32_t centre,
                                            std::uint32_t c) const noexcept {
    for (const std::uint32_t i : angles_.of(centre)) {
        const Angle& angle = topology_->angles[i];
        if ((angle.a == a && angle.c == c) || (angle.a == c && angle.c == a)) return angle.theta0;
    }
    return std::nullopt;
}

bool BondGraph::is_planar(std::uint32_t atom) const noexcept {
    const std::span<const std::uint32_t> around = neighbours(atom);
    if (around.size() != 3) return false;
    constexpr double open = 2 * std::numbers::pi / 3, least = 350.0 / 180.0 * std::numbers::pi;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        sum += find_angle(around[i], atom, around[(i + 1) % 3]).value_or(open);
    }
    return sum >= least;
}

}  // namespace palpa
