// Atoms by the place of the group that they turn with.
#pragma once
#include "math/vec.h"
#include "prepare/bond_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace palpa {

// Atoms by where the group that they belong to has its centre, which never moves.
class AnchorGrid {
public:
    explicit AnchorGrid(std::vector<Vec3> anchors) : anchors_(std::move(anchors)) {
        low_ = Vec3::Zero();
        Vec3 high = Vec3::Zero();
        if (!anchors_.empty()) low_ = high = anchors_[0];
        for (const Vec3& anchor : anchors_) {
            low_ = low_.cwiseMin(anchor);
            high = high.cwiseMax(anchor);
        }
        // Far apart atoms must not make more cells than there are atoms.
        const double room = ((high - low_).array() + 1.0).prod();
        edge_ = std::max(5.0, std::cbrt(8 * room / (static_cast<double>(anchors_.size()) + 1)));
        for (int k = 0; k < 3; ++k) cells_[k] = static_cast<int>((high - low_)[k] / edge_) + 1;
        std::vector<std::array<std::uint32_t, 2>> entries;
        for (std::uint32_t atom = 0; atom < anchors_.size(); ++atom) {
            std::array<int, 3> cell{};
            for (int k = 0; k < 3; ++k)
                cell[k] = static_cast<int>((anchors_[atom] - low_)[k] / edge_);
            entries.push_back({index(cell), atom});
        }
        atoms_ = Lists(entries, static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2]);
    }

    // Calls `visit` for every atom whose anchor is within the radius.
    template <class Visit>
    void visit_near(const Vec3& place, double radius, const Visit& visit) const {
        std::array<int, 3> first{}, last{};
        for (int k = 0; k < 3; ++k) {
            const double from = std::floor((place[k] - radius - low_[k]) / edge_);
            const double to = std::floor((place[k] + radius - low_[k]) / edge_);
            first[k] = static_cast<int>(std::clamp(from, 0.0, cells_[k] - 1.0));
            last[k] = static_cast<int>(std::clamp(to, 0.0, cells_[k] - 1.0));
        }
        for (int x = first[0]; x <= last[0]; ++x) {
            for (int y = first[1]; y <= last[1]; ++y) {
                for (int z = first[2]; z <= last[2]; ++z) {
                    for (const std::uint32_t atom : atoms_.of(index({x, y, z}))) {
                        if ((anchors_[atom] - place).squaredNorm() < radius * radius) visit(atom);
                    }
                }
            }
        }
    }

private:
    std::uint32_t index(const std::array<int, 3>& cell) const noexcept {
        return static_cast<std::uint32_t>((cell[0] * cells_[1] + cell[1]) * cells_[2] + cell[2]);
    }

    std::vector<Vec3> anchors_;
    Vec3 low_;
    double edge_ = 5;  // Å
    std::array<int, 3> cells_{1, 1, 1};
    Lists atoms_;
};

}  // namespace palpa
