#include "field/cluster_tree.h"

namespace palpa {

ClusterPlaces find_places(std::span<const std::uint32_t, cluster_size> atoms,
                          std::span<const Vec3> positions) noexcept {
    constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
    ClusterPlaces places;
    for (std::size_t k = 0; k < cluster_size; ++k) {
        const bool is_somewhere = atoms[k] < positions.size() && positions[atoms[k]].allFinite();
        const Vec3 at = is_somewhere ? positions[atoms[k]] : Vec3(Vec3::Constant(nowhere));
        places.x[k] = at.x();
        places.y[k] = at.y();
        places.z[k] = at.z();
    }
    return places;
}

void ClusterTree::build(std::span<const std::uint32_t> atoms, std::span<const Vec3> positions) {
    const std::size_t clusters = atoms.size() / cluster_size;
    places_.resize(clusters);
    boxes_.resize(clusters);
    ranges_.resize(4 * clusters);
    for (std::size_t c = 0; c < clusters; ++c) place(atoms, positions, c);
    if (clusters > 0) build_range({0, 0, clusters});
}

void ClusterTree::move(std::span<const std::uint32_t> atoms, std::span<const Vec3> positions,
                       std::uint32_t cluster) noexcept {
    place(atoms, positions, cluster);
    move_range({0, 0, places_.size()}, cluster);
}

void ClusterTree::place(std::span<const std::uint32_t> atoms, std::span<const Vec3> positions,
                        std::size_t cluster) noexcept {
    const ClusterPlaces& places = places_[cluster] =
        find_places(atoms.subspan(cluster * cluster_size).first<cluster_size>(), positions);
    Box box;
    for (std::size_t k = 0; k < cluster_size; ++k) {
        const Vec3 at(places.x[k], places.y[k], places.z[k]);
        if (at.allFinite()) box.add(at);
    }
    boxes_[cluster] = box;
}

void ClusterTree::build_range(const Range& range) noexcept {
    Box& box = ranges_[range.node];
    box = boxes_[range.begin];
    if (range.size() == 1) return;
    build_range(range.left());
    build_range(range.right());
    box = ranges_[range.left().node];
    box.add(ranges_[range.right().node]);
}

void ClusterTree::move_range(const Range& range, std::size_t cluster) noexcept {
    Box& box = ranges_[range.node];
    box = boxes_[range.begin];
    if (range.size() == 1) return;
    move_range(cluster < range.left().end ? range.left() : range.right(), cluster);
    box = ranges_[range.left().node];
    box.add(ranges_[range.right().node]);
}

}  // namespace palpa
