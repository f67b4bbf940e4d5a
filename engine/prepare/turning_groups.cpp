#include "prepare/turning_groups.h"

#include <algorithm>
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
