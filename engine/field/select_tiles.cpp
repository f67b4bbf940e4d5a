#include "field/select_tiles.h"

#include "field/cluster_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::uint32_t absent = no_atom;

// Bit r becomes bit 8 r.
std::uint64_t spread(std::uint64_t rows) noexcept {
    rows = (rows | rows << 28) & 0x0000000f0000000f;
    rows = (rows | rows << 14) & 0x0003000300030003;
    return (rows | rows << 7) & 0x0101010101010101;
}

// The groups of a cluster's atoms; places without an atom have that of the first.
struct ClusterGroups {
    std::array<std::uint32_t, cluster_size> of;
    bool is_mixed;  // not all have one

    std::uint32_t rows_unlike(std::uint32_t group) const noexcept {
        std::uint32_t rows = 0;
        for (std::size_t row = 0; row < cluster_size; ++row) {
            if (of[row] != group) rows |= 1U << row;
        }
        return rows;
    }
    std::uint64_t pairs_unlike(const ClusterGroups& columns) const noexcept {
        constexpr std::uint64_t every_row = 0x0101010101010101;
        if (!is_mixed) return columns.rows_unlike(of[0]) * every_row;
        if (!columns.is_mixed) return spread(rows_unlike(columns.of[0])) * 0xff;
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

// Which pairs of two clusters are wanted: near, and of two groups.
class PairChoice {
public:
    PairChoice(const ClusterList& list, std::span<const std::uint32_t> groups,
               std::span<const Vec3> positions, double skin)
        : list_(list),
          groups_(groups.empty() ? std::vector<ClusterGroups>()
                                 : find_cluster_groups(list, groups)),
          positions_(positions),
          reach2_((list.cutoff + skin) * (list.cutoff + skin)),
          places_(list.clusters()),
          is_placed_(list.clusters(), 0) {}

    // Bit 8 r + c is that of row r and atom c of `cluster`.
    std::uint64_t find(std::uint32_t row_cluster, std::uint32_t cluster) {
        if (cluster == list_.clusters()) return 0;
        std::uint64_t pairs = ~std::uint64_t{0};
        if (!groups_.empty()) {
            if (is_one_group(groups_[row_cluster], groups_[cluster])) return 0;
            pairs = groups_[row_cluster].pairs_unlike(groups_[cluster]);
        }
        if (!std::isfinite(reach2_)) return pairs;
        return pairs & find_near_pairs(places(row_cluster), places(cluster), reach2_);
    }

private:
    // Most clusters are never asked for.
    const ClusterPlaces& places(std::uint32_t cluster) {
        if (is_placed_[cluster] == 0) {
            const auto atoms = std::span(list_.atoms).subspan(cluster * cluster_size);
            places_[cluster] = find_places(atoms.first<cluster_size>(), positions_);
            is_placed_[cluster] = 1;
        }
        return places_[cluster];
    }

    const ClusterList& list_;
    std::vector<ClusterGroups> groups_;
    std::span<const Vec3> positions_;
    double reach2_;
    std::vector<ClusterPlaces> places_;
    std::vector<std::uint8_t> is_placed_;
};

std::uint32_t columns_of(std::uint64_t pairs) noexcept {
    pairs |= pairs >> 32;
    pairs |= pairs >> 16;
    pairs |= pairs >> 8;
    return static_cast<std::uint32_t>(pairs & 0xff);
}

std::uint32_t rows_of(std::uint64_t pairs) noexcept {
    std::uint32_t rows = 0;
    for (std::size_t row = 0; row < cluster_size; ++row) {
        if ((pairs >> (row * cluster_size) & 0xff) != 0) rows |= 1U << row;
    }
    return rows;
}

// Tiles by the clusters of the whole list, those of row cluster c: [first[c], first[c + 1]).
template <class Tile>
struct Selected {
    std::vector<std::size_t> first;
    std::vector<Tile> tiles;
};

Selected<ClusterTile> select_plain(const ClusterList& list, PairChoice& choice) {
    struct Found {
        std::uint32_t row_cluster;
        ClusterTile tile;
    };
    std::vector<Found> found;
    found.reserve(list.plain.size());
    Selected<ClusterTile> result;
    result.first.assign(list.clusters() + 2, 0);
    for (std::uint32_t c = 0; c < list.clusters(); ++c) {
        for (std::size_t i = list.first_plain[c]; i < list.first_plain[c + 1]; ++i) {
            const std::uint32_t cluster = list.plain[i].cluster;
            const std::uint64_t pairs = choice.find(c, cluster);
            if (pairs == 0) continue;
            const std::uint32_t rows = rows_of(pairs), columns = columns_of(pairs);
            const bool is_turned = std::popcount(columns) < std::popcount(rows);
            found.push_back(is_turned ? Found{cluster, {c, columns}} : Found{c, {cluster, rows}});
            ++result.first[found.back().row_cluster + 2];
        }
    }
    std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
    result.tiles.resize(found.size());
    for (const auto& [row_cluster, tile] : found)
        result.tiles[result.first[row_cluster + 1]++] = tile;
    result.first.pop_back();
    // Tiles with the same rows stand together, as in the whole list.
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        const auto begin = result.tiles.begin();
        std::sort(begin + static_cast<std::ptrdiff_t>(result.first[c]),
                  begin + static_cast<std::ptrdiff_t>(result.first[c + 1]),
                  [](const ClusterTile& a, const ClusterTile& b) {
                      return std::pair(~a.rows, a.cluster) < std::pair(~b.rows, b.cluster);
                  });
    }
    return result;
}

Selected<MaskedTile> select_masked(const ClusterList& list, PairChoice& choice) {
    Selected<MaskedTile> result;
    result.first.assign(1, 0);
    for (std::uint32_t c = 0; c < list.clusters(); ++c) {
        for (std::size_t i = list.first_masked[c]; i < list.first_masked[c + 1]; ++i) {
            const auto [cluster, present] = list.masked[i];
            if (present == 0) continue;
            const std::uint64_t pairs = present & choice.find(c, cluster);
            if (pairs != 0) result.tiles.push_back({cluster, pairs});
        }
        result.first.push_back(result.tiles.size());
    }
    return result;
}

// Numbers the clusters of some tiles anew, in the order of the whole list.
class Numbering {
public:
    explicit Numbering(std::size_t clusters) : number_of_(clusters, absent) {}

    template <class Tile>
    void add(const Selected<Tile>& selected) {
        for (std::size_t c = 0; c < number_of_.size(); ++c) {
            if (selected.first[c] != selected.first[c + 1]) number_of_[c] = 0;
        }
        for (const Tile& tile : selected.tiles) number_of_[tile.cluster] = 0;
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
    void place(const Selected<Tile>& selected, std::uint32_t empty, std::vector<std::size_t>& first,
               std::vector<Tile>& tiles) const {
        first.assign(1, 0);
        for (std::size_t c = 0; c < number_of_.size(); ++c) {
            if (number_of_[c] == absent) continue;
            for (std::size_t i = selected.first[c]; i < selected.first[c + 1]; ++i) {
                tiles.push_back(selected.tiles[i]);
                tiles.back().cluster = number_of_[tiles.back().cluster];
            }
            if (tiles.size() % 2 != 0) tiles.push_back({empty, 0});
            first.push_back(tiles.size());
        }
    }

private:
    std::vector<std::uint32_t> number_of_;  // of each cluster of the whole list
};

// A wide processor takes two tiles at a time, with the rows of both; so that every one sums the
// same pairs, both have them.
void share_rows(std::vector<ClusterTile>& tiles) {
    for (std::size_t i = 0; i + 1 < tiles.size(); i += 2) {
        tiles[i].rows = tiles[i + 1].rows = tiles[i].rows | tiles[i + 1].rows;
    }
}

}  // namespace

ClusterList select_tiles(const ClusterList& list, std::span<const std::uint32_t> groups,
                         std::span<const Vec3> positions, double skin) {
    PairChoice choice(list, groups, positions, std::min(skin, list.skin));
    const Selected<ClusterTile> plain = select_plain(list, choice);
    const Selected<MaskedTile> masked = select_masked(list, choice);
    Numbering numbering(list.clusters());
    numbering.add(plain);
    numbering.add(masked);
    ClusterList result;
    result.cutoff = list.cutoff;
    result.skin = std::min(skin, list.skin);
    numbering.number(list, result);
    const auto empty = static_cast<std::uint32_t>(result.clusters());
    numbering.place(plain, empty, result.first_plain, result.plain);
    share_rows(result.plain);
    numbering.place(masked, empty, result.first_masked, result.masked);
    return result;
}

}  // namespace palpa
