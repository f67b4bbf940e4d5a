#include "field/cluster_list.h"

#include "core/assertion.h"
#include "field/near_rows.h"

#include <algorithm>
#include <bit>
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

// Sorted, one for each tile that leaves something out. Every tile of a cluster with itself does:
// each pair counts once, and no atom acts on itself.
void find_gaps(std::size_t atom_count, std::span<const std::array<std::uint32_t, 2>> left_out,
               ClusterList& list) {
    std::vector<std::uint32_t>& place = list.memory.place_of;
    place.resize(atom_count);
    for (std::uint32_t p = 0; p < list.atoms.size(); ++p) {
        if (list.atoms[p] != no_atom) place[list.atoms[p]] = p;
    }
    std::vector<TileGap>& gaps = list.memory.gaps;
    gaps.clear();
    gaps.reserve(left_out.size() + list.clusters());
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
    for (std::uint32_t c = 0; c < list.clusters(); ++c) gaps.push_back({c, c, lower_half});
    std::sort(gaps.begin(), gaps.end(), [](const TileGap& a, const TileGap& b) {
        return std::tie(a.row_cluster, a.cluster) < std::tie(b.row_cluster, b.cluster);
    });
    std::size_t count = 0;
    for (const TileGap& gap : gaps) {
        if (count > 0 && gaps[count - 1].row_cluster == gap.row_cluster &&
            gaps[count - 1].cluster == gap.cluster) {
            gaps[count - 1].pairs |= gap.pairs;
        } else {
            gaps[count++] = gap;
        }
    }
    gaps.resize(count);
    list.memory.first_gap.assign(list.clusters() + 1, 0);
    for (const TileGap& gap : gaps) ++list.memory.first_gap[gap.row_cluster + 1];
    std::partial_sum(list.memory.first_gap.begin(), list.memory.first_gap.end(),
                     list.memory.first_gap.begin());
}

// Tiles with the same rows stand together: a wide processor takes them two at a time.
bool stands_before(const ClusterTile& a, const ClusterTile& b) noexcept {
    return std::pair(~a.rows, a.cluster) < std::pair(~b.rows, b.cluster);
}

bool stands_before(const MaskedTile& a, const MaskedTile& b) noexcept {
    return a.cluster < b.cluster;
}

// The tiles of one cluster, sorted at the end.
class TileRow {
public:
    TileRow(const ClusterList& list, std::size_t row_cluster, std::vector<ClusterTile>& plain,
            std::vector<MaskedTile>& masked)
        : plain_(plain), masked_(masked), first_plain_(plain.size()) {
        const ClusterListMemory& memory = list.memory;
        gaps_ = std::span(memory.gaps)
                    .subspan(memory.first_gap[row_cluster],
                             memory.first_gap[row_cluster + 1] - memory.first_gap[row_cluster]);
    }

    // Clusters must rise. Rows are those that may be near.
    void add(std::uint32_t cluster, std::uint32_t rows) {
        while (!gaps_.empty() && gaps_.front().cluster < cluster) gaps_ = gaps_.subspan(1);
        if (gaps_.empty() || gaps_.front().cluster != cluster) {
            plain_.push_back({cluster, rows});
            return;
        }
        std::uint64_t pairs = ~gaps_.front().pairs;
        for (std::size_t row = 0; row < cluster_size; ++row) {
            if (!(rows >> row & 1)) pairs &= ~(std::uint64_t{0xff} << (row * 8));
        }
        if (pairs != 0) masked_.push_back({cluster, pairs});
    }

    void sort() {
        std::sort(plain_.begin() + static_cast<std::ptrdiff_t>(first_plain_), plain_.end(),
                  [](const ClusterTile& a, const ClusterTile& b) { return stands_before(a, b); });
    }

private:
    std::span<const TileGap> gaps_;
    std::vector<ClusterTile>& plain_;
    std::vector<MaskedTile>& masked_;
    std::size_t first_plain_;
};

// Room for as many tiles and some that come with moves.
std::size_t with_room(std::size_t tiles) noexcept { return (tiles + tiles / 8 + 3) / 2 * 2; }

std::size_t made_even(std::size_t tiles) noexcept { return (tiles + 1) / 2 * 2; }

void clear_tiles(ClusterList& list) {
    list.plain.clear();
    list.masked.clear();
    list.first_plain.assign(1, 0);
    list.first_masked.assign(1, 0);
}

// Ends the tiles of one cluster, the rest of them the empty cluster's.
template <class RoomFor>
void end_row(ClusterList& list, const RoomFor& room_for) {
    const auto empty = static_cast<std::uint32_t>(list.clusters());
    const std::size_t plain = list.first_plain.back(), masked = list.first_masked.back();
    list.plain.resize(plain + room_for(list.plain.size() - plain), {empty, 0});
    list.masked.resize(masked + room_for(list.masked.size() - masked), {empty, 0});
    list.first_plain.push_back(list.plain.size());
    list.first_masked.push_back(list.masked.size());
}

// Rows of a cluster that have an atom.
std::uint32_t rows_of(const ClusterList& list, std::uint32_t cluster) noexcept {
    std::uint32_t rows = 0;
    for (std::size_t row = 0; row < cluster_size; ++row) {
        if (list.atoms[cluster * cluster_size + row] != no_atom) rows |= 1U << row;
    }
    return rows;
}

constexpr std::uint32_t mixed = no_atom;

// What all atoms of each cluster have.
std::vector<std::uint32_t> find_groups(const ClusterList& list,
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

double reach2_of(const ClusterList& list) noexcept {
    return (list.cutoff + list.skin) * (list.cutoff + list.skin);
}

std::span<const std::uint32_t> atoms_of(const ClusterList& list, std::size_t cluster) noexcept {
    return std::span(list.atoms).subspan(cluster * cluster_size, cluster_size);
}

// The square of how far an atom is from its place in the list; NaN where it is nowhere.
double moved2(const ClusterList& list, std::span<const Vec3> positions,
              std::uint32_t atom) noexcept {
    return (positions[atom] - list.positions[atom]).squaredNorm();
}

bool has_moved(const ClusterList& list, std::span<const Vec3> positions, std::uint32_t cluster,
               double most2) noexcept {
    return std::ranges::any_of(atoms_of(list, cluster), [&](std::uint32_t atom) {
        return atom != no_atom && !(moved2(list, positions, atom) <= most2);
    });
}

// Beyond it pairs may be missing.
double half_skin2(const ClusterList& list) noexcept { return 0.25 * list.skin * list.skin; }

// Clusters that have moved so far are found again with those beyond half the skin.
double renewed_from2(const ClusterList& list) noexcept { return 0.0625 * list.skin * list.skin; }

// Finds tiles of clusters that have moved in place of those that a list has.
class ListUpdate {
public:
    explicit ListUpdate(ClusterList& list) : list_(list), memory_(list.memory) {}

    // Of the clusters `memory.moved`, rising.
    void run(std::span<const Vec3> positions) {
        for (const std::uint32_t cluster : memory_.moved) memory_.is_moved[cluster] = 1;
        touch_present_rows();
        for (const std::uint32_t cluster : memory_.moved) move(cluster, positions);
        find_tiles();
        sort_found();
        write_rows();
        for (const std::uint32_t cluster : memory_.moved) memory_.is_moved[cluster] = 0;
        for (const std::uint32_t cluster : memory_.touched) {
            memory_.is_touched[cluster] = 0;
            memory_.slots[cluster] = 0;
        }
    }

private:
    void contact(std::uint32_t row_cluster) {
        if (memory_.is_touched[row_cluster] != 0) return;
        memory_.is_touched[row_cluster] = 1;
        memory_.touched.push_back(row_cluster);
    }

    // Rows that have a tile with a cluster that has moved, all of them and some more.
    void touch_present_rows() {
        memory_.touched.clear();
        for (const std::uint32_t cluster : memory_.moved) {
            memory_.tree.visit_near(cluster, 0, cluster + 1, reach2_,
                                    [&](std::uint32_t other) { contact(other); });
        }
    }

    void move(std::uint32_t cluster, std::span<const Vec3> positions) {
        memory_.tree.move(list_.atoms, positions, cluster);
        for (const std::uint32_t atom : atoms_of(list_, cluster)) {
            if (atom != no_atom) list_.positions[atom] = positions[atom];
        }
    }

    // Counts the tiles of each row in `slots`.
    void find_tiles() {
        memory_.found.clear();
        const ClusterTree& tree = memory_.tree;
        const auto add = [&](std::uint32_t row_cluster, std::uint32_t cluster) {
            const std::uint32_t rows =
                find_near_rows(tree.places(row_cluster), tree.places(cluster), reach2_);
            if (rows == 0) return;
            contact(row_cluster);
            memory_.found.push_back({row_cluster, cluster, rows});
            ++memory_.slots[row_cluster];
        };
        for (const std::uint32_t cluster : memory_.moved) {
            tree.visit_near(cluster, 0, list_.clusters(), reach2_, [&](std::uint32_t other) {
                if (other >= cluster) {
                    add(cluster, other);
                } else if (memory_.is_moved[other] == 0) {
                    add(other, cluster);
                }
            });
        }
    }

    // By row; in a row clusters rise, as they were found. `slots` says the end of each row.
    void sort_found() {
        std::sort(memory_.touched.begin(), memory_.touched.end());
        std::size_t end = 0;
        for (const std::uint32_t row : memory_.touched)
            end += std::exchange(memory_.slots[row], end);
        memory_.sorted.resize(memory_.found.size());
        for (const auto& tile : memory_.found)
            memory_.sorted[memory_.slots[tile.row_cluster]++] = tile;
    }

    // How many tiles of a row stay and how many are new.
    struct RowCounts {
        std::size_t kept_plain, kept_masked, new_plain, new_masked;
    };

    void write_rows() {
        std::vector<RowCounts> counts;
        counts.reserve(memory_.touched.size());
        bool fits = true;
        std::size_t next = 0;
        for (const std::uint32_t c : memory_.touched) {
            const std::size_t plain = new_plain_.size(), masked = new_masked_.size();
            TileRow row(list_, c, new_plain_, new_masked_);
            for (; next < memory_.slots[c]; ++next)
                row.add(memory_.sorted[next].cluster, memory_.sorted[next].rows);
            row.sort();
            const RowCounts count{drop(row_of(list_.plain, list_.first_plain, c), c),
                                  drop(row_of(list_.masked, list_.first_masked, c), c),
                                  new_plain_.size() - plain, new_masked_.size() - masked};
            counts.push_back(count);
            fits = fits && count.kept_plain + count.new_plain <= room(list_.first_plain, c) &&
                   count.kept_masked + count.new_masked <= room(list_.first_masked, c);
        }
        if (!fits) {
            make_room(counts, list_.plain, list_.first_plain,
                      [](const RowCounts& count) { return count.kept_plain + count.new_plain; });
            make_room(counts, list_.masked, list_.first_masked,
                      [](const RowCounts& count) { return count.kept_masked + count.new_masked; });
        }
        std::span<const ClusterTile> new_plain = new_plain_;
        std::span<const MaskedTile> new_masked = new_masked_;
        for (const ClusterTile& tile : new_plain)
            memory_.rows += static_cast<std::size_t>(std::popcount(tile.rows));
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const std::uint32_t c = memory_.touched[i];
            merge(row_of(list_.plain, list_.first_plain, c), counts[i].kept_plain,
                  new_plain.first(counts[i].new_plain));
            merge(row_of(list_.masked, list_.first_masked, c), counts[i].kept_masked,
                  new_masked.first(counts[i].new_masked));
            new_plain = new_plain.subspan(counts[i].new_plain);
            new_masked = new_masked.subspan(counts[i].new_masked);
        }
    }

    template <class Tile>
    static std::span<Tile> row_of(std::vector<Tile>& tiles, const std::vector<std::size_t>& first,
                                  std::size_t cluster) noexcept {
        return std::span(tiles).subspan(first[cluster], room(first, cluster));
    }

    static std::size_t room(const std::vector<std::size_t>& first, std::size_t cluster) noexcept {
        return first[cluster + 1] - first[cluster];
    }

    static bool is_filling(const ClusterTile& tile) noexcept { return tile.rows == 0; }
    static bool is_filling(const MaskedTile& tile) noexcept { return tile.pairs == 0; }
    void forget(const ClusterTile& tile) noexcept {
        memory_.rows -= static_cast<std::size_t>(std::popcount(tile.rows));
    }
    void forget(const MaskedTile&) noexcept {}

    // Leaves the tiles of a row whose clusters have not moved and returns how many.
    template <class Tile>
    std::size_t drop(std::span<Tile> row, std::uint32_t row_cluster) noexcept {
        const bool all = memory_.is_moved[row_cluster] != 0;
        std::size_t kept = 0;
        for (const Tile& tile : row) {
            if (is_filling(tile)) break;
            if (all || memory_.is_moved[tile.cluster] != 0) {
                forget(tile);
            } else {
                row[kept++] = tile;
            }
        }
        for (Tile& tile : row.subspan(kept)) {
            if (is_filling(tile)) break;
            tile = {static_cast<std::uint32_t>(list_.clusters()), 0};
        }
        return kept;
    }

    // Lays out all rows again, those that are too short with room to spare.
    template <class Tile, class CountOf>
    void make_room(std::span<const RowCounts> counts, std::vector<Tile>& tiles,
                   std::vector<std::size_t>& first, const CountOf& count_of) const {
        const Tile filling{static_cast<std::uint32_t>(list_.clusters()), 0};
        std::vector<Tile> laid_out;
        laid_out.reserve(tiles.size() + tiles.size() / 16);
        std::size_t next = 0;
        for (std::size_t c = 0; c < list_.clusters(); ++c) {
            const std::span<const Tile> row = row_of(tiles, first, c);
            std::size_t size = row.size();
            if (next < counts.size() && memory_.touched[next] == c) {
                const std::size_t count = count_of(counts[next++]);
                if (count > size) size = with_room(count);
            }
            first[c] = laid_out.size();
            laid_out.insert(laid_out.end(), row.begin(), row.end());
            laid_out.resize(first[c] + size, filling);
        }
        first.back() = laid_out.size();
        tiles = std::move(laid_out);
    }

    // Adds new tiles to the first `kept` of a row, both sorted.
    template <class Tile>
    static void merge(std::span<Tile> row, std::size_t kept, std::span<const Tile> added) noexcept {
        std::size_t end = kept + added.size();
        while (!added.empty()) {
            if (kept > 0 && stands_before(added.back(), row[kept - 1])) {
                row[--end] = row[--kept];
            } else {
                row[--end] = added.back();
                added = added.first(added.size() - 1);
            }
        }
    }

    ClusterList& list_;
    ClusterListMemory& memory_;
    double reach2_ = reach2_of(list_);
    std::vector<ClusterTile> new_plain_;
    std::vector<MaskedTile> new_masked_;
};

// The clusters of `memory.moved`, if any.
ListChange renew(std::span<const Vec3> positions,
                 std::span<const std::array<std::uint32_t, 2>> left_out, ClusterList& list) {
    if (list.memory.moved.empty()) return ListChange::None;
    if (2 * list.memory.moved.size() <= list.clusters()) {
        ListUpdate(list).run(positions);
        if (4 * list.memory.rows <= 5 * list.memory.rows_at_build) return ListChange::Tiles;
    }
    const double cutoff = list.cutoff, skin = list.skin;
    list = build_cluster_list(positions, left_out, cutoff, skin, std::move(list));
    return ListChange::Clusters;
}

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
    find_gaps(atom_count, left_out, list);
    const std::vector<std::uint32_t> group_of = find_groups(list, groups);
    clear_tiles(list);
    for (std::uint32_t row_cluster = 0; row_cluster < list.clusters(); ++row_cluster) {
        const std::uint32_t rows = rows_of(list, row_cluster);
        TileRow row(list, row_cluster, list.plain, list.masked);
        for (std::uint32_t c = row_cluster; c < list.clusters(); ++c) {
            const bool is_left_out =
                !group_of.empty() && group_of[c] != mixed && group_of[c] == group_of[row_cluster];
            if (!is_left_out) row.add(c, rows);
        }
        row.sort();
        end_row(list, made_even);
    }
    return list;
}

ClusterList build_cluster_list(std::span<const Vec3> positions,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               double cutoff, double skin, ClusterList storage) {
    PALPA_ASSERT(cutoff > 0 && skin >= 0 && std::isfinite(cutoff + skin));
    ClusterList list = std::move(storage);
    ClusterListMemory& memory = list.memory;
    list.cutoff = cutoff;
    list.skin = skin;
    list.positions.assign(positions.begin(), positions.end());
    list.atoms = sort_into_clusters(positions);
    find_gaps(positions.size(), left_out, list);
    memory.tree.build(std::span(list.atoms).first(list.clusters() * cluster_size), positions);
    memory.is_moved.assign(list.clusters(), 0);
    memory.is_touched.assign(list.clusters(), 0);
    memory.slots.assign(list.clusters(), 0);
    clear_tiles(list);
    const double reach2 = reach2_of(list);
    for (std::uint32_t cluster = 0; cluster < list.clusters(); ++cluster) {
        TileRow row(list, cluster, list.plain, list.masked);
        const ClusterPlaces& places = memory.tree.places(cluster);
        memory.tree.visit_near(cluster, cluster, list.clusters(), reach2, [&](std::uint32_t other) {
            const std::uint32_t rows = find_near_rows(places, memory.tree.places(other), reach2);
            if (rows != 0) row.add(other, rows);
        });
        row.sort();
        end_row(list, with_room);
    }
    memory.rows = 0;
    for (const ClusterTile& tile : list.plain)
        memory.rows += static_cast<std::size_t>(std::popcount(tile.rows));
    memory.rows_at_build = memory.rows;
    return list;
}

ListChange update_cluster_list(std::span<const Vec3> positions,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               ClusterList& list) {
    if (!is_outdated(list, positions)) return ListChange::None;
    list.memory.moved.clear();
    for (std::uint32_t c = 0; c < list.clusters(); ++c) {
        if (has_moved(list, positions, c, renewed_from2(list))) list.memory.moved.push_back(c);
    }
    return renew(positions, left_out, list);
}

ListChange update_cluster_list(std::span<const Vec3> positions,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               std::span<const std::uint32_t> moved, ClusterList& list) {
    if (list.positions.empty()) return ListChange::None;
    PALPA_ASSERT(positions.size() == list.positions.size());
    const double most2 = half_skin2(list);
    if (std::ranges::all_of(
            moved, [&](std::uint32_t atom) { return moved2(list, positions, atom) <= most2; }))
        return ListChange::None;
    ClusterListMemory& memory = list.memory;
    memory.moved.clear();
    for (const std::uint32_t atom : moved) {
        const auto cluster = static_cast<std::uint32_t>(memory.place_of[atom] / cluster_size);
        if (memory.is_moved[cluster] != 0 || moved2(list, positions, atom) <= renewed_from2(list))
            continue;
        memory.is_moved[cluster] = 1;
        memory.moved.push_back(cluster);
    }
    std::sort(memory.moved.begin(), memory.moved.end());
    return renew(positions, left_out, list);
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
    const double most2 = half_skin2(list);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!((positions[i] - list.positions[i]).squaredNorm() <= most2)) return true;
    }
    return false;
}

}  // namespace palpa
