#include "prepare/turning_groups.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <utility>

namespace palpa {
namespace {

using std::numbers::pi;
using Kind = OrientedGroup::Kind;

class GroupFinder {
public:
    GroupFinder(const BondGraph& graph, std::span<const std::uint32_t> built, std::size_t atoms,
                const OrientSettings& settings)
        : graph_(graph), settings_(settings), is_built_(atoms, false) {
        for (const std::uint32_t atom : built) is_built_[atom] = true;
    }

    std::vector<TurningGroup> find() const {
        std::vector<TurningGroup> groups;
        for (std::uint32_t atom = 0; atom < is_built_.size(); ++atom) {
            if (auto group = find_turning(atom)) groups.push_back(std::move(*group));
        }
        std::stable_sort(
            groups.begin(), groups.end(),
            [](const TurningGroup& a, const TurningGroup& b) { return a.kind < b.kind; });
        if (!settings_.may_flip) return groups;
        for (const auto finder : {&GroupFinder::find_amide, &GroupFinder::find_imidazole}) {
            for (std::uint32_t atom = 0; atom < is_built_.size(); ++atom) {
                if (auto group = (this->*finder)(atom)) groups.push_back(std::move(*group));
            }
        }
        return groups;
    }

private:
    struct Around {
        std::vector<std::uint32_t> heavy, hydrogens;
        bool all_built = true;  // of the hydrogens
    };
    Around look_around(std::uint32_t atom) const {
        Around around;
        for (const std::uint32_t other : graph_.neighbours(atom)) {
            const bool is_hydrogen = graph_.is_hydrogen(other);
            (is_hydrogen ? around.hydrogens : around.heavy).push_back(other);
            if (is_hydrogen && !is_built_[other]) around.all_built = false;
        }
        return around;
    }

    bool is_carbon(std::uint32_t atom) const noexcept { return graph_.has_mass(atom, 12); }
    bool is_nitrogen(std::uint32_t atom) const noexcept { return graph_.has_mass(atom, 14); }

    std::optional<TurningGroup> find_turning(std::uint32_t atom) const {
        if (graph_.is_hydrogen(atom) || graph_.is_planar(atom)) return std::nullopt;
        Around around = look_around(atom);
        if (around.hydrogens.empty() || !around.all_built) return std::nullopt;
        TurningGroup group{.kind = Kind::Rotor,
                           .centre = atom,
                           .axis = {},
                           .moved = around.hydrogens,
                           .dihedrals = {},
                           .impropers = {}};
        if (around.heavy.empty() && around.hydrogens.size() > 1) {
            group.kind = Kind::Water;
            return group;
        }
        if (around.heavy.size() != 1 || (is_carbon(atom) && !settings_.has_methyls))
            return std::nullopt;
        group.axis = around.heavy[0];
        if (around.hydrogens.size() == 3) group.period = 2 * pi / 3;
        return group;
    }

    // By its carbon: a neighbour, O with no other, NH2.
    std::optional<TurningGroup> find_amide(std::uint32_t carbon) const {
        if (!is_carbon(carbon) || graph_.neighbours(carbon).size() != 3) return std::nullopt;
        std::optional<std::uint32_t> axis, o, n;
        Around of_n;
        for (const std::uint32_t other : graph_.neighbours(carbon)) {
            if (graph_.has_mass(other, 16) && graph_.neighbours(other).size() == 1) {
                o = other;
            } else if (is_nitrogen(other) && graph_.neighbours(other).size() == 3 &&
                       look_around(other).hydrogens.size() == 2) {
                n = other;
                of_n = look_around(other);
            } else if (!graph_.is_hydrogen(other)) {
                axis = other;
            }
        }
        if (!axis || !o || !n || !of_n.all_built) return std::nullopt;
        return TurningGroup{.kind = Kind::Amide,
                            .centre = carbon,
                            .axis = axis,
                            .moved = {*o, *n, of_n.hydrogens[0], of_n.hydrogens[1]},
                            .dihedrals = {},
                            .impropers = {}};
    }

    // By the carbon with the substituent: N C N C follow in the ring.
    std::optional<TurningGroup> find_imidazole(std::uint32_t carbon) const {
        if (!is_carbon(carbon) || graph_.neighbours(carbon).size() != 3) return std::nullopt;
        for (const std::uint32_t first_n : graph_.neighbours(carbon)) {
            if (!is_nitrogen(first_n)) continue;
            for (const std::uint32_t middle : graph_.neighbours(first_n)) {
                if (middle == carbon || !is_carbon(middle)) continue;
                for (const std::uint32_t second_n : graph_.neighbours(middle)) {
                    if (second_n == first_n || !is_nitrogen(second_n)) continue;
                    for (const std::uint32_t last : graph_.neighbours(second_n)) {
                        if (last == middle || !is_carbon(last)) continue;
                        if (auto group = make_imidazole({carbon, first_n, middle, second_n, last}))
                            return group;
                    }
                }
            }
        }
        return std::nullopt;
    }

    std::optional<TurningGroup> make_imidazole(const std::array<std::uint32_t, 5>& ring) const {
        const auto in_ring = [&](std::uint32_t atom) {
            return std::find(ring.begin(), ring.end(), atom) != ring.end();
        };
        if (std::ranges::count(graph_.neighbours(ring[0]), ring[4]) == 0) return std::nullopt;
        TurningGroup group{.kind = Kind::Imidazole,
                           .centre = ring[0],
                           .axis = {},
                           .moved = {},
                           .dihedrals = {},
                           .impropers = {}};
        for (const std::uint32_t other : graph_.neighbours(ring[0])) {
            if (!in_ring(other) && !graph_.is_hydrogen(other)) group.axis = other;
        }
        if (!group.axis) return std::nullopt;
        for (std::size_t i = 1; i < ring.size(); ++i) {
            const Around around = look_around(ring[i]);
            const bool is_closed = std::all_of(around.heavy.begin(), around.heavy.end(), in_ring);
            if (!is_closed || !around.all_built) return std::nullopt;
            group.moved.push_back(ring[i]);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            for (const std::uint32_t h : look_around(group.moved[i]).hydrogens) {
                group.moved.push_back(h);
            }
        }
        return group;
    }

    const BondGraph& graph_;
    const OrientSettings& settings_;
    std::vector<bool> is_built_;
};

}  // namespace

std::vector<TurningGroup> find_turning_groups(const BondGraph& graph,
                                              std::span<const std::uint32_t> built,
                                              std::size_t atoms, const OrientSettings& settings) {
    return GroupFinder(graph, built, atoms, settings).find();
}

}  // namespace palpa
