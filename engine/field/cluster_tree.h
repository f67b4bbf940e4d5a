// A tree of bounding boxes of atom clusters, to find neighbouring clusters and to update it when a
// few have moved.
#pragma once
#include "field/near_rows.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpa {

// A bounding box; empty before the first point.
struct Box {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;

    void add(const Vec3& place) noexcept {
        low = low.cwiseMin(place);
        high = high.cwiseMax(place);
    }
    void add(const Box& other) noexcept {
        low = low.cwiseMin(other.low);
        high = high.cwiseMax(other.high);
    }
    double distance2(const Box& other) const noexcept {
        return (low - other.high).cwiseMax(other.low - high).cwiseMax(0).squaredNorm();
    }
};

// Where eight atoms are; one that is not among `positions`, or is nowhere, has no place.
ClusterPlaces find_places(std::span<const std::uint32_t, cluster_size> atoms,
                          std::span<const Vec3> positions) noexcept;

// Clusters that stand near each other have numbers near each other, or it is slow.
class ClusterTree {
public:
    // `atoms`: eight a cluster. An atom that is not one of `positions`, or is nowhere, has no
    // place.
    void build(std::span<const std::uint32_t> atoms, std::span<const Vec3> positions);

    // Updates the tree after the atoms of one cluster have moved.
    void move(std::span<const std::uint32_t> atoms, std::span<const Vec3> positions,
              std::uint32_t cluster) noexcept;

    const ClusterPlaces& places(std::size_t cluster) const noexcept { return places_[cluster]; }

    // Calls visit(c), c rising, for clusters in [first, last) whose boxes are not further than the
    // root of `reach2` from that of `cluster`.
    template <class Visit>
    void visit_near(std::uint32_t cluster, std::size_t first, std::size_t last, double reach2,
                    const Visit& visit) const {
        if (!boxes_.empty())
            visit_range({boxes_[cluster], first, last, reach2}, {0, 0, places_.size()}, visit);
    }

private:
    struct Query {
        const Box& box;
        std::size_t first, last;
        double reach2;
    };
    // A range of clusters and the index of its box.
    struct Range {
        std::size_t node, begin, end;

        std::size_t size() const noexcept { return end - begin; }
        Range left() const noexcept { return {2 * node + 1, begin, (begin + end) / 2}; }
        Range right() const noexcept { return {2 * node + 2, (begin + end) / 2, end}; }
    };

    template <class Visit>
    void visit_range(const Query& query, const Range& range, const Visit& visit) const {
        if (range.end <= query.first || range.begin >= query.last) return;
        if (ranges_[range.node].distance2(query.box) > query.reach2) return;
        if (range.size() == 1) {
            visit(static_cast<std::uint32_t>(range.begin));
            return;
        }
        visit_range(query, range.left(), visit);
        visit_range(query, range.right(), visit);
    }

    void place(std::span<const std::uint32_t> atoms, std::span<const Vec3> positions,
               std::size_t cluster) noexcept;
    void build_range(const Range& range) noexcept;
    void move_range(const Range& range, std::size_t cluster) noexcept;

    std::vector<ClusterPlaces> places_;
    std::vector<Box> boxes_, ranges_;
};

}  // namespace palpa
