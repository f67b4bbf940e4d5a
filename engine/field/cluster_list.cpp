#include "field/cluster_list.h"

#include "core/assertion.h"
#include "field/near_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

std::size_t clusters_of(std::size_t atom_count) noexcept {
    return (atom_count + cluster_size - 1) / cluster_size;
}

// Halves the atoms until each part is a cluster; only the last part can be smaller.
void halve(std::span<const Vec3> positions, std::span<std::uint32_t> atoms) {
    while (atoms.size() > cluster_size) {
        Vec3 low = positions[atoms[0]], high = low;
        for (const std::uint32_t atom : atoms) {
            low = low.cwiseMin(positions[atom]);
            high = high.cwiseMax(positions[atom]);
        }
        Eigen::Index axis = 0;
        (high - low).maxCoeff(&axis);
        const std::size_t half = clusters_of(atoms.size()) / 2 * cluster_size;
        std::nth_element(atoms.begin(), atoms.begin() + static_cast<std::ptrdiff_t>(half),
                         atoms.end(), [&](std::uint32_t a, std::uint32_t b) {
                             return std::pair(positions[a](axis), a) <
                                    std::pair(positions[b](axis), b);
                         });
        halve(positions, atoms.first(half));
        atoms = atoms.subspan(half);
    }
    std::sort(atoms.begin(), atoms.end());
}

// The atoms as the list has them; an atom that is nowhere stands at the origin, so that there is an
// order.
std::vector<std::uint32_t> sort_into_clusters(std::span<const Vec3> positions) {
    std::vector<Vec3> places(positions.begin(), positions.end());
    for (Vec3& place : places) {
        if (!place.allFinite()) place = Vec3::Zero();
    }
    std::vector<std::uint32_t> atoms((clusters_of(positions.size()) + 1) * cluster_size, no_atom);
    const std::span sorted = std::span(atoms).first(positions.size());
    std::iota(sorted.begin(), sorted.end(), 0U);
    halve(places, sorted);
    return atoms;
}

// Pairs that a tile leaves out.
struct Gap {
    std::uint32_t row_cluster, cluster;
    std::uint64_t pairs;
};

// Sorted, one for each tile that leaves something out. Every tile of a cluster with itself does:
// each pair counts once, and no atom acts on itself.
std::vector<Gap> find_gaps(std::span<const std::uint32_t> atoms, std::size_t atom_count,
                           std::span<const std::array<std::uint32_t, 2>> left_out) {
    std::vector<std::uint32_t> place(atom_count);
    for (std::uint32_t p = 0; p < atoms.size(); ++p) {
        if (atoms[p] != no_atom) place[atoms[p]] = p;
    }
    std::vector<Gap> gaps;
    gaps.reserve(left_out.size() + clusters_of(atom_count));
    for (const auto& [a, b] : left_out) {
        const auto [low, high] = std::minmax(place[a], place[b]);
        gaps.push_back({low / 8, high / 8,
                        std::uint64_t{1} << (low % cluster_size * 8 + high % cluster_size)});
    }
    constexpr std::uint64_t lower_half = [] {
        std::uint64_t pairs = 0;
        for (std::size_t row = 0; row < cluster_size; ++row) {
            for (std::size_t column = 0; column <= row; ++column)
                pairs |= std::uint64_t{1} << (row * 8 + column);
        }
        return pairs;
    }();
    for (std::uint32_t c = 0; c < clusters_of(atom_count); ++c) gaps.push_back({c, c, lower_half});
    std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) {
        return std::tie(a.row_cluster, a.cluster) < std::tie(b.row_cluster, b.cluster);
    });
    std::size_t count = 0;
    for (const Gap& gap : gaps) {
        if (count > 0 && gaps[count - 1].row_cluster == gap.row_cluster &&
            gaps[count - 1].cluster == gap.cluster) {
            gaps[count - 1].pairs |= gap.pairs;
        } else {
            gaps[count++] = gap;
        }
    }
    gaps.resize(count);
    return gaps;
}

// Writes the tiles of one cluster after the other.
class TileWriter {
public:
    TileWriter(std::span<const Gap> gaps, std::span<const std::uint32_t> groups, ClusterList& list)
        : gaps_(gaps), groups_(find_groups(list, groups)), list_(list) {
        list_.plain.clear();
        list_.masked.clear();
        list_.first_plain.assign(1, 0);
        list_.first_masked.assign(1, 0);
    }

    // Clusters must rise. Rows are those that may be near.
    void add(std::uint32_t cluster, std::uint32_t rows) {
        const auto row_cluster = static_cast<std::uint32_t>(list_.first_plain.size() - 1);
        if (!groups_.empty() && groups_[cluster] != mixed &&
            groups_[cluster] == groups_[row_cluster])
            return;
        while (next_ < gaps_.size() && std::tie(gaps_[next_].row_cluster, gaps_[next_].cluster) <
                                           std::tie(row_cluster, cluster)) {
            ++next_;
        }
        if (next_ == gaps_.size() || gaps_[next_].row_cluster != row_cluster ||
            gaps_[next_].cluster != cluster) {
            list_.plain.push_back({cluster, rows});
            return;
        }
        std::uint64_t pairs = ~gaps_[next_].pairs;
        for (std::size_t row = 0; row < cluster_size; ++row) {
            if (!(rows >> row & 1)) pairs &= ~(std::uint64_t{0xff} << (row * 8));
        }
        if (pairs != 0) list_.masked.push_back({cluster, pairs});
    }

    // Tiles with the same rows stand together: a wide processor takes them two at a time.
    void end_cluster() {
        const auto empty = static_cast<std::uint32_t>(list_.clusters());
        std::sort(list_.plain.begin() + static_cast<std::ptrdiff_t>(list_.first_plain.back()),
                  list_.plain.end(), [](const ClusterTile& a, const ClusterTile& b) {
                      return std::pair(~a.rows, a.cluster) < std::pair(~b.rows, b.cluster);
                  });
        if (list_.plain.size() % 2 != 0) list_.plain.push_back({empty, 0});
        if (list_.masked.size() % 2 != 0) list_.masked.push_back({empty, 0});
        list_.first_plain.push_back(list_.plain.size());
        list_.first_masked.push_back(list_.masked.size());
    }

private:
    static constexpr std::uint32_t mixed = no_atom;

    // What all atoms of each cluster have.
    static std::vector<std::uint32_t> find_groups(const ClusterList& list,
                                                  std::span<const std::uint32_t> groups) {
        std::vector<std::uint32_t> result;
        for (std::size_t c = 0; !groups.empty() && c < list.clusters(); ++c) {
            const auto atoms = std::span(list.atoms).subspan(c * cluster_size, cluster_size);
            std::uint32_t common = groups[atoms[0]];
            for (const std::uint32_t atom : atoms) {
                if (atom != no_atom && groups[atom] != common) common = mixed;
            }
            result.push_back(common);
        }
        return result;
    }

    std::span<const Gap> gaps_;
    std::vector<std::uint32_t> groups_;
    ClusterList& list_;
    std::size_t next_ = 0;
};

// Rows of a cluster that have an atom.
std::uint32_t rows_of(const ClusterList& list, std::uint32_t cluster) noexcept {
    std::uint32_t rows = 0;
    for (std::size_t row = 0; row < cluster_size; ++row) {
        if (list.atoms[cluster * cluster_size + row] != no_atom) rows |= 1U << row;
    }
    return rows;
}

struct Box {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;

    void add(const Vec3& place) noexcept {
        low = low.cwiseMin(place);
        high = high.cwiseMax(place);
    }
    double distance2(const Box& other) const noexcept {
        return (low - other.high).cwiseMax(other.low - high).cwiseMax(0).squaredNorm();
    }
};

// The boxes of clusters and of ranges of clusters, halved again and again.
class NeighbourFinder {
public:
    NeighbourFinder(const ClusterList& list, std::span<const Vec3> positions, double reach)
        : list_(list), reach2_(reach * reach), places_(list.clusters()), boxes_(list.clusters()) {
        constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
        for (std::size_t c = 0; c < list.clusters(); ++c) {
            for (std::size_t k = 0; k < cluster_size; ++k) {
                const std::uint32_t atom = list.atoms[c * cluster_size + k];
                const bool is_somewhere = atom != no_atom && positions[atom].allFinite();
                const Vec3 place = is_somewhere ? positions[atom] : Vec3(Vec3::Constant(nowhere));
                if (is_somewhere) boxes_[c].add(place);
                places_[c].x[k] = place.x();
                places_[c].y[k] = place.y();
                places_[c].z[k] = place.z();
            }
        }
        ranges_.resize(4 * list.clusters());
        if (list.clusters() > 0) build_range(0, 0, list.clusters());
    }

    // Adds the tiles of a cluster with itself and those after it.
    void add_tiles(std::uint32_t cluster, TileWriter& writer) const {
        add_near(cluster, 0, 0, list_.clusters(), writer);
    }

private:
    Box build_range(std::size_t node, std::size_t begin, std::size_t end) {
        if (end - begin == 1) return ranges_[node] = boxes_[begin];
        const std::size_t middle = (begin + end) / 2;
        Box box = build_range(2 * node + 1, begin, middle);
        const Box right = build_range(2 * node + 2, middle, end);
        box.low = box.low.cwiseMin(right.low);
        box.high = box.high.cwiseMax(right.high);
        return ranges_[node] = box;
    }

    void add_near(std::uint32_t cluster, std::size_t node, std::size_t begin, std::size_t end,
                  TileWriter& writer) const {
        if (end <= cluster || ranges_[node].distance2(boxes_[cluster]) > reach2_) return;
        if (end - begin > 1) {
            const std::size_t middle = (begin + end) / 2;
            add_near(cluster, 2 * node + 1, begin, middle, writer);
            add_near(cluster, 2 * node + 2, middle, end, writer);
            return;
        }
        const std::uint32_t rows = find_near_rows(places_[cluster], places_[begin], reach2_);
        if (rows != 0) writer.add(static_cast<std::uint32_t>(begin), rows);
    }

    const ClusterList& list_;
    double reach2_;
    std::vector<ClusterPlaces> places_;
    std::vector<Box> boxes_, ranges_;
};

}  // namespace

ClusterList build_full_cluster_list(std::size_t atom_count,
                                    std::span<const std::array<std::uint32_t, 2>> left_out,
                                    std::span<const std::uint32_t> groups) {
    ClusterList list;
    list.atoms.assign((clusters_of(atom_count) + 1) * cluster_size, no_atom);
    const auto end = list.atoms.begin() + static_cast<std::ptrdiff_t>(atom_count);
    std::iota(list.atoms.begin(), end, 0U);
    if (!groups.empty()) {
        std::stable_sort(list.atoms.begin(), end,
                         [&](std::uint32_t a, std::uint32_t b) { return groups[a] < groups[b]; });
    }
    const std::vector<Gap> gaps = find_gaps(list.atoms, atom_count, left_out);
    TileWriter writer(gaps, groups, list);
    for (std::uint32_t row_cluster = 0; row_cluster < list.clusters(); ++row_cluster) {
        const std::uint32_t rows = rows_of(list, row_cluster);
        for (std::uint32_t c = row_cluster; c < list.clusters(); ++c) writer.add(c, rows);
        writer.end_cluster();
    }
    return list;
}

ClusterList build_cluster_list(std::span<const Vec3> positions,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               double cutoff, double skin, ClusterList storage) {
    PALPA_ASSERT(cutoff > 0 && skin >= 0 && std::isfinite(cutoff + skin));
    ClusterList list = std::move(storage);
    list.cutoff = cutoff;
    list.skin = skin;
    list.positions.assign(positions.begin(), positions.end());
    list.atoms = sort_into_clusters(positions);
    const std::vector<Gap> gaps = find_gaps(list.atoms, positions.size(), left_out);
    TileWriter writer(gaps, {}, list);
    const NeighbourFinder finder(list, positions, cutoff + skin);
    for (std::uint32_t cluster = 0; cluster < list.clusters(); ++cluster) {
        finder.add_tiles(cluster, writer);
        writer.end_cluster();
    }
    return list;
}

std::vector<std::array<std::uint32_t, 2>> list_pairs(const ClusterList& list) {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    const auto add = [&](std::size_t row_cluster, std::size_t cluster, std::uint64_t which) {
        for (std::size_t bit = 0; bit < cluster_size * cluster_size; ++bit) {
            const std::uint32_t a = list.atoms[row_cluster * cluster_size + bit / cluster_size];
            const std::uint32_t b = list.atoms[cluster * cluster_size + bit % cluster_size];
            if ((which >> bit & 1) != 0 && a != no_atom && b != no_atom) pairs.push_back({a, b});
        }
    };
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        for (std::size_t i = list.first_plain[c]; i < list.first_plain[c + 1]; ++i) {
            const ClusterTile& tile = list.plain[i];
            std::uint64_t which = 0;
            for (std::size_t row = 0; row < cluster_size; ++row) {
                if ((tile.rows >> row & 1) != 0) which |= std::uint64_t{0xff} << (row * 8);
            }
            add(c, tile.cluster, which);
        }
        for (std::size_t i = list.first_masked[c]; i < list.first_masked[c + 1]; ++i) {
            add(c, list.masked[i].cluster, list.masked[i].pairs);
        }
    }
    return pairs;
}

bool is_outdated(const ClusterList& list, std::span<const Vec3> positions) noexcept {
    if (list.positions.empty()) return false;
    PALPA_ASSERT(positions.size() == list.positions.size());
    const double most2 = 0.25 * list.skin * list.skin;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!((positions[i] - list.positions[i]).squaredNorm() <= most2)) return true;
    }
    return false;
}

}  // namespace palpa
