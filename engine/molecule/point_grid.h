// A grid of points for neighbour queries.
#pragma once
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// Fixed points. Points that are not finite are near nothing.
class PointGrid {
public:
    // `edge`: of a cell, Å; larger where points are few, so that there are hardly more cells than
    // points, however far apart these are.
    explicit PointGrid(std::vector<Vec3> points, double edge = 5);

    // Calls `visit` with the index of every point that is at most `radius` (Å) away, cell by cell,
    // in a cell by rising index.
    template <class Visit>
    void visit_near(const Vec3& place, double radius, const Visit& visit) const {
        (void)find_cell(place, radius, [&](std::span<const std::uint32_t> points) {
            for (const std::uint32_t point : points) {
                if ((points_[point] - place).squaredNorm() <= radius * radius) visit(point);
            }
            return false;
        });
    }

    // Whether any point is at most `radius` (Å) away.
    bool has_near(const Vec3& place, double radius) const noexcept {
        return find_cell(place, radius, [&](std::span<const std::uint32_t> points) {
            for (const std::uint32_t point : points) {
                if ((points_[point] - place).squaredNorm() <= radius * radius) return true;
            }
            return false;
        });
    }

private:
    // A range of cells.
    struct Block {
        std::array<std::uint32_t, 3> first, last;
    };
    Block block_around(const Vec3& place, double radius) const noexcept;
    std::array<std::uint32_t, 3> cell_of(const Vec3& place) const noexcept;
    std::size_t index(std::uint32_t x, std::uint32_t y, std::uint32_t z) const noexcept {
        return (static_cast<std::size_t>(x) * cells_[1] + y) * cells_[2] + z;
    }
    bool is_out_of_reach(const Vec3& place, double radius) const noexcept;

    // Visits the cells around a place until `use` returns true for the points of one.
    template <class Use>
    bool find_cell(const Vec3& place, double radius, const Use& use) const {
        if (order_.empty() || is_out_of_reach(place, radius)) return false;
        const Block block = block_around(place, radius);
        for (std::uint32_t x = block.first[0]; x <= block.last[0]; ++x) {
            for (std::uint32_t y = block.first[1]; y <= block.last[1]; ++y) {
                // Cells along z are contiguous, and so are their points.
                const std::size_t begin = first_[index(x, y, block.first[2])];
                const std::size_t end = first_[index(x, y, block.last[2]) + 1];
                if (use(std::span(order_).subspan(begin, end - begin))) return true;
            }
        }
        return false;
    }

    std::vector<Vec3> points_;
    Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();  // Å
    double edge_;                                    // Å
    std::array<std::uint32_t, 3> cells_{1, 1, 1};
    // Points by their cells: those of cell c are [first_[c], first_[c + 1]) of `order_`.
    std::vector<std::uint32_t> first_, order_;
};

}  // namespace palpa
