#include "statics/close_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

using Pair = std::array<std::uint32_t, 2>;

Pair ordered(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

std::vector<Pair> list_left_out(const FastAtoms& atoms) {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < atoms.first_replaced; ++i)
        pairs.push_back(ordered(atoms.left_out[i][0], atoms.left_out[i][1]));
    std::ranges::sort(pairs);
    return pairs;
}

// Atoms of pairs that may change: mobile ones, and fixed ones that are in reach of any, with some
// that are not.
std::vector<std::uint32_t> list_changing(const TorsionModel& model, std::span<const Vec3> positions,
                                         double reach) {
    if (model.mobile_atoms.size() == positions.size()) return model.mobile_atoms;
    using Cell = std::array<double, 3>;
    const auto cell_of = [&](std::uint32_t atom) {
        const Vec3 cell = (positions[atom] / reach).array().floor();
        return Cell{cell.x(), cell.y(), cell.z()};
    };
    const auto keep_one_of_each = [](std::vector<Cell>& cells) {
        std::ranges::sort(cells);
        const auto doubles = std::ranges::unique(cells);
        cells.erase(doubles.begin(), doubles.end());
    };
    std::vector<Cell> own, reached;
    for (const std::uint32_t atom : model.mobile_atoms) own.push_back(cell_of(atom));
    keep_one_of_each(own);
    for (const auto& [x, y, z] : own) {
        for (const double dx : {-1, 0, 1}) {
            for (const double dy : {-1, 0, 1}) {
                for (const double dz : {-1, 0, 1}) reached.push_back({x + dx, y + dy, z + dz});
            }
        }
    }
    keep_one_of_each(reached);
    std::vector<std::uint32_t> atoms;
    for (std::uint32_t atom = 0; atom < positions.size(); ++atom) {
        if (std::ranges::binary_search(reached, cell_of(atom))) atoms.push_back(atom);
    }
    return atoms;
}

}  // namespace

ClosePairs build_close_pairs(const TorsionModel& model, std::span<const Vec3> positions,
                             std::span<const std::uint32_t> held, double near_reach, double reach) {
    constexpr double too_close = 0.8;
    // What does not move against each other is of one group.
    const std::vector<std::uint32_t>& group_of = model.fast.atoms.groups;
    const std::vector<double>& half_rmin = model.fast.atoms.half_rmin;
    const std::vector<Pair> left_out = list_left_out(model.fast.atoms);
    std::vector<bool> is_held(positions.size(), false);
    for (const std::uint32_t atom : held) is_held[atom] = true;
    std::vector<std::uint32_t> by_x = list_changing(model, positions, reach);
    std::ranges::sort(by_x, {}, [&](std::uint32_t atom) { return positions[atom].x(); });
    ClosePairs close;
    for (std::size_t i = 0; i < by_x.size(); ++i) {
        const std::uint32_t a = by_x[i];
        for (std::size_t j = i + 1; j < by_x.size(); ++j) {
            const std::uint32_t b = by_x[j];
            const Vec3 between = positions[b] - positions[a];
            if (between.x() > reach) break;
            const double square = between.squaredNorm();
            const bool is_exact = is_held[a] != is_held[b] && square < near_reach * near_reach;
            if (square > reach * reach || group_of[a] == group_of[b] || is_exact) continue;
            if (std::ranges::binary_search(left_out, ordered(a, b))) continue;
            close.pairs.push_back(ordered(a, b));
            const double least =
                too_close * std::min(std::sqrt(square), half_rmin[a] + half_rmin[b]);
            close.least_squares.push_back(least * least);
        }
    }
    return close;
}

bool are_too_close(const ClosePairs& close, std::span<const Vec3> positions) noexcept {
    for (std::size_t i = 0; i < close.pairs.size(); ++i) {
        const auto& [a, b] = close.pairs[i];
        if ((positions[a] - positions[b]).squaredNorm() < close.least_squares[i]) return true;
    }
    return false;
}

}  // namespace palpa
