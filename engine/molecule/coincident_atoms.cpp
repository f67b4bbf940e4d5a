#include "molecule/coincident_atoms.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace palpa {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const Cell& cell) const noexcept {
        std::uint64_t hash = 0;
        for (const std::int64_t index : cell) {
            hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15;
            hash ^= hash >> 32U;
        }
        return hash;
    }
};

// Cubes as wide as the distance, so that atoms that are closer are in the same or in adjacent ones.
// Each holds the few atoms that are not closer than that to each other.
class Grid {
public:
    Grid(std::span<const Vec3> positions, double distance)
        : positions_(positions), distance_(distance) {}

    // The first atom of the grid that is closer than the distance.
    std::optional<std::size_t> find_near(std::size_t atom) const {
        const Cell centre = cell_of(atom);
        std::optional<std::size_t> nearest;
        for (std::int64_t i = 0; i < 27; ++i) {
            const auto found = cells_.find(
                {centre[0] + i % 3 - 1, centre[1] + i / 3 % 3 - 1, centre[2] + i / 9 - 1});
            if (found == cells_.end()) continue;
            for (const std::size_t other : found->second) {
                if ((positions_[atom] - positions_[other]).norm() >= distance_) continue;
                nearest = std::min(other, nearest.value_or(other));
            }
        }
        return nearest;
    }

    void add(std::size_t atom) { cells_[cell_of(atom)].push_back(atom); }

private:
    Cell cell_of(std::size_t atom) const {
        Cell cell{};
        for (std::size_t axis = 0; axis < cell.size(); ++axis) {
            const double place = positions_[atom][static_cast<Eigen::Index>(axis)];
            cell[axis] = static_cast<std::int64_t>(std::floor(place / distance_));
        }
        return cell;
    }

    std::span<const Vec3> positions_;
    double distance_;  // Å
    std::unordered_map<Cell, std::vector<std::size_t>, CellHash> cells_;
};

}  // namespace

std::vector<std::array<std::size_t, 2>> find_coincident_atoms(std::span<const Vec3> positions,
                                                              double distance) {
    Grid grid(positions, distance);
    std::vector<std::array<std::size_t, 2>> pairs;
    for (std::size_t atom = 0; atom < positions.size(); ++atom) {
        if (const auto first = grid.find_near(atom)) {
            pairs.push_back({*first, atom});
        } else {
            grid.add(atom);
        }
    }
    return pairs;
}

std::optional<std::string> describe_coincident_atoms(std::span<const AtomName> names,
                                                     std::span<const Vec3> positions,
                                                     double distance) {
    const auto pairs = find_coincident_atoms(positions, distance);
    if (pairs.empty()) return std::nullopt;
    const auto distance_of = [&](const std::array<std::size_t, 2>& pair) {
        return (positions[pair[0]] - positions[pair[1]]).norm();
    };
    const auto closest = *std::ranges::min_element(pairs, {}, distance_of);
    std::string text = fmt::format("{} and {} are {:.2f} Å apart", to_string(names[closest[0]]),
                                   to_string(names[closest[1]]), distance_of(closest));
    if (pairs.size() > 1) text += fmt::format(", and {} more such pairs", pairs.size() - 1);
    return text;
}

}  // namespace palpa
