#include "field/group_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::uint32_t absent = no_atom;

// The groups of a cluster's atoms; places without an atom have that of the first.
struct ClusterGroups {
    std::array<std::uint32_t, cluster_size> of;
    bool is_mixed;  // not all have one

    // Rows that have another group than one given, or than one of the columns.
    std::uint32_t rows_unlike(std::uint32_t group) const noexcept {
        std::uint32_t rows = 0;
        for (std::size_t row = 0; row < cluster_size; ++row) {
            if (of[row] != group) rows |= 1U << row;
        }
        return rows;
    }
    std::uint32_t rows_unlike(const ClusterGroups& columns) const noexcept {
        if (!columns.is_mixed) return rows_unlike(columns.of[0]);
        // No row is like all columns of a mixed cluster.
        return 0xff;
    }
    std::uint64_t pairs_unlike(const ClusterGroups& columns) const noexcept {
        std::uint64_t pairs = 0;
        for (std::size_t row = 0; row < cluster_size; ++row) {
            pairs |= std::uint64_t{columns.rows_unlike(of[row])} << (row * cluster_size);
        }
        return pairs;
    }
};

std::vector<ClusterGroups> find_cluster_groups(const ClusterList& list,
                                               std::span<const std::uint32_t> groups) {
    std::vector<ClusterGroups> result(list.clusters());
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        const auto atoms = std::span(list.atoms).subspan(c * cluster_size, cluster_size);
        ClusterGroups& found = result[c];
        found.is_mixed = false;
        for (std::size_t k = 0; k < cluster_size; ++k) {
            found.of[k] = groups[atoms[k] == no_atom ? atoms[0] : atoms[k]];
            if (found.of[k] != found.of[0]) found.is_mixed = true;
        }
    }
    return result;
}

bool is_one_group(const ClusterGroups& a, const ClusterGroups& b) noexcept {
    return !a.is_mixed && !b.is_mixed && a.of[0] == b.of[0];
}

// Tiles by the clusters of the whole list; those of one row cluster are brought together at the
// end.
template <class Tile>
struct Selected {
    std::uint32_t row_cluster;
    Tile tile;
};

bool is_before(const Selected<ClusterTile>& a, const Selected<ClusterTile>& b) noexcept {
    if (a.row_cluster != b.row_cluster) return a.row_cluster < b.row_cluster;
    // Tiles with the same rows stand together, as in the whole list.
    return a.tile.rows != b.tile.rows ? a.tile.rows > b.tile.rows : a.tile.cluster < b.tile.cluster;
}

std::vector<Selected<ClusterTile>> select_plain(const ClusterList& list,
                                                std::span<const ClusterGroups> groups) {
    std::vector<Selected<ClusterTile>> result;
    for (std::uint32_t c = 0; c < list.clusters(); ++c) {
        for (std::size_t i = list.first_plain[c]; i < list.first_plain[c + 1]; ++i) {
            const auto [cluster, near] = list.plain[i];
            if (cluster == list.clusters() || is_one_group(groups[c], groups[cluster])) continue;
            const std::uint32_t rows = near & groups[c].rows_unlike(groups[cluster]);
            const std::uint32_t columns = groups[cluster].rows_unlike(groups[c]);
            if (std::popcount(columns) < std::popcount(rows)) {
                result.push_back({cluster, {c, columns}});
            } else if (rows != 0) {
                result.push_back({c, {cluster, rows}});
            }
        }
    }
    std::sort(result.begin(), result.end(), is_before);
    return result;
}

std::vector<Selected<MaskedTile>> select_masked(const ClusterList& list,
                                                std::span<const ClusterGroups> groups) {
    std::vector<Selected<MaskedTile>> result;
    for (std::uint32_t c = 0; c < list.clusters(); ++c) {
        for (std::size_t i = list.first_masked[c]; i < list.first_masked[c + 1]; ++i) {
            auto [cluster, pairs] = list.masked[i];
            if (cluster == list.clusters() || is_one_group(groups[c], groups[cluster])) continue;
            pairs &= groups[c].pairs_unlike(groups[cluster]);
            if (pairs != 0) result.push_back({c, {cluster, pairs}});
        }
    }
    return result;
}

// Numbers the clusters of some tiles anew, in the order of the whole list.
class Numbering {
public:
    explicit Numbering(std::size_t clusters) : number_of_(clusters, absent) {}

    template <class Tile>
    void add(std::span<const Selected<Tile>> selected) {
        for (const auto& [row_cluster, tile] : selected) {
            number_of_[row_cluster] = number_of_[tile.cluster] = 0;
        }
    }

    // Puts the atoms of the numbered clusters into `to`, and the empty cluster behind them.
    void number(const ClusterList& from, ClusterList& to) {
        std::uint32_t count = 0;
        for (std::size_t c = 0; c < number_of_.size(); ++c) {
            if (number_of_[c] == absent) continue;
            number_of_[c] = count++;
            const auto atoms = from.atoms.begin() + static_cast<std::ptrdiff_t>(c * cluster_size);
            to.atoms.insert(to.atoms.end(), atoms, atoms + cluster_size);
        }
        to.atoms.insert(to.atoms.end(), cluster_size, no_atom);
    }

    // Even numbers of tiles for each cluster, filled up with the empty cluster's.
    template <class Tile>
    void place(std::span<const Selected<Tile>> selected, std::size_t clusters,
               std::vector<std::size_t>& first, std::vector<Tile>& tiles) const {
        std::size_t next = 0;
        first.assign(1, 0);
        for (std::uint32_t c = 0; c < clusters; ++c) {
            for (; next < selected.size() && number_of_[selected[next].row_cluster] == c; ++next) {
                tiles.push_back(selected[next].tile);
                tiles.back().cluster = number_of_[tiles.back().cluster];
            }
            if (tiles.size() % 2 != 0) tiles.push_back({static_cast<std::uint32_t>(clusters), 0});
            first.push_back(tiles.size());
        }
    }

    // A wide processor takes two tiles at a time, with the rows of both; so that every one sums the
    // same pairs, both have them.
    static void share_rows(std::vector<ClusterTile>& tiles) {
        for (std::size_t i = 0; i + 1 < tiles.size(); i += 2) {
            tiles[i].rows = tiles[i + 1].rows = tiles[i].rows | tiles[i + 1].rows;
        }
    }

private:
    std::vector<std::uint32_t> number_of_;  // of each cluster of the whole list
};

}  // namespace

ClusterList select_tiles_between_groups(const ClusterList& list,
                                        std::span<const std::uint32_t> groups) {
    const std::vector<ClusterGroups> cluster_groups = find_cluster_groups(list, groups);
    const std::vector<Selected<ClusterTile>> plain = select_plain(list, cluster_groups);
    const std::vector<Selected<MaskedTile>> masked = select_masked(list, cluster_groups);
    Numbering numbering(list.clusters());
    numbering.add(std::span(plain));
    numbering.add(std::span(masked));
    ClusterList result;
    result.cutoff = list.cutoff;
    result.skin = list.skin;
    numbering.number(list, result);
    const std::size_t clusters = result.clusters();
    numbering.place(std::span(plain), clusters, result.first_plain, result.plain);
    Numbering::share_rows(result.plain);
    numbering.place(std::span(masked), clusters, result.first_masked, result.masked);
    return result;
}

}  // namespace palpa
