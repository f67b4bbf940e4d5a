#include "forces/pair_list.h"

#include "core/assertion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpa {
namespace {

// Cells with an edge of half the reach, so that neighbours are at most two cells away. A cell is
// named by one number in which x counts singly, y and z in strides: cells in a row along x follow
// each other. Only cells with atoms exist, so the extent of a system does not matter.
constexpr std::uint64_t stride_y = std::uint64_t{1} << 21;
constexpr std::uint64_t stride_z = std::uint64_t{1} << 42;
constexpr std::uint64_t reach_cells = 2;

// Coordinates beyond a million cells share the outermost one; what is no number gets the lowest.
std::uint64_t cell_along(double place) noexcept {
    constexpr double half = 1 << 20;
    const double cell = std::floor(place) + half;
    if (!(cell > reach_cells)) return reach_cells;
    return static_cast<std::uint64_t>(std::min(cell, 2 * half - 1 - reach_cells));
}

struct Placed {
    std::uint64_t cell;
    std::uint32_t atom;
    friend auto operator<=>(const Placed&, const Placed&) = default;
};

std::vector<Placed> sort_into_cells(std::span<const Vec3> positions, double edge) {
    std::vector<Placed> placed(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3 place = positions[i] / edge;
        placed[i] = {cell_along(place.x()) + stride_y * cell_along(place.y()) +
                         stride_z * cell_along(place.z()),
                     static_cast<std::uint32_t>(i)};
    }
    std::sort(placed.begin(), placed.end());
    return placed;
}

// Atoms in the order of their cells, an array per property.
struct SortedAtoms {
    std::vector<std::uint32_t> atom;
    std::vector<double> x, y, z;
    // Which pairs are left out: those with an atom marked 1 in the row at hand, and those of two
    // atoms marked 2.
    std::vector<std::uint8_t> marks;
    // Ranks that rank p leaves out, all higher than p: [first[p], first[p + 1]) of `excluded`.
    std::vector<std::uint32_t> first_excluded, excluded;
};

constexpr std::uint8_t excluded_mark = 1, fixed_mark = 2;

// Turns the exclusions of atoms into those of ranks.
void add_exclusions(const Exclusions& exclusions, SortedAtoms& sorted) {
    const std::size_t n = sorted.atom.size();
    std::vector<std::uint32_t> rank(n);
    for (std::uint32_t p = 0; p < n; ++p) rank[sorted.atom[p]] = p;
    // Counted in the entry after the next, so that filling moves each to its place.
    sorted.first_excluded.assign(n + 2, 0);
    const auto for_each = [&](const auto& use) {
        for (std::size_t i = 0; i < n; ++i) {
            for (const std::uint32_t j : exclusions.of(i)) {
                use(std::min(rank[i], rank[j]), std::max(rank[i], rank[j]));
            }
        }
    };
    for_each([&](std::uint32_t low, std::uint32_t) { ++sorted.first_excluded[low + 2]; });
    std::partial_sum(sorted.first_excluded.begin(), sorted.first_excluded.end(),
                     sorted.first_excluded.begin());
    sorted.excluded.resize(exclusions.atoms.size());
    for_each([&](std::uint32_t low, std::uint32_t high) {
        sorted.excluded[sorted.first_excluded[low + 1]++] = high;
    });
}

SortedAtoms sort_atoms(std::span<const Placed> placed, std::span<const Vec3> positions,
                       std::span<const std::uint8_t> is_fixed, const Exclusions& exclusions) {
    SortedAtoms sorted;
    for (const Placed& atom : placed) {
        const Vec3& place = positions[atom.atom];
        sorted.atom.push_back(atom.atom);
        sorted.x.push_back(place.x());
        sorted.y.push_back(place.y());
        sorted.z.push_back(place.z());
        sorted.marks.push_back(!is_fixed.empty() && is_fixed[atom.atom] ? fixed_mark : 0);
    }
    add_exclusions(exclusions, sorted);
    return sorted;
}

// Ranks [begin, end).
struct Run {
    std::size_t begin, end;
};

// The rows of cells that come after a cell's own and reach it: half of the 5 x 5 around it.
constexpr std::array<std::uint64_t, 12> following_rows = [] {
    std::array<std::uint64_t, 12> rows{};
    std::size_t count = 0;
    for (std::uint64_t y = 1; y <= reach_cells; ++y) rows[count++] = y * stride_y;
    for (std::uint64_t z = 1; z <= reach_cells; ++z) {
        for (std::uint64_t y = 0; y <= 2 * reach_cells; ++y)
            rows[count++] = z * stride_z + y * stride_y - reach_cells * stride_y;
    }
    return rows;
}();

// Where atoms near those of a cell stand, but for its own row of cells: one run for each row.
// Called for rising cells, so that each search goes on from the last.
class RunFinder {
public:
    explicit RunFinder(std::span<const Placed> placed) noexcept : placed_(placed) {}

    Run find(std::size_t which, std::uint64_t cell) noexcept {
        const std::uint64_t middle = cell + following_rows[which];
        Run& run = runs_[which];
        while (run.begin < placed_.size() && placed_[run.begin].cell < middle - reach_cells)
            ++run.begin;
        while (run.end < placed_.size() && placed_[run.end].cell <= middle + reach_cells) ++run.end;
        return run;
    }

private:
    std::span<const Placed> placed_;
    std::array<Run, following_rows.size()> runs_{};
};

class RowWriter {
public:
    RowWriter(const SortedAtoms& sorted, double reach, PairList& list) noexcept
        : sorted_(sorted), reach2_(reach * reach), list_(list) {}

    // Adds the neighbours of rank p among a run that leaves p out.
    void add(std::size_t p, Run run) {
        if (list_.neighbours.size() < count_ + (run.end - run.begin))
            list_.neighbours.resize(2 * (count_ + (run.end - run.begin)));
        const double x = sorted_.x[p], y = sorted_.y[p], z = sorted_.z[p];
        const std::uint8_t left_out = excluded_mark | (sorted_.marks[p] & fixed_mark);
        std::uint32_t* const neighbours = list_.neighbours.data();
        std::size_t count = count_;
        for (std::size_t q = run.begin; q < run.end; ++q) {
            const double dx = x - sorted_.x[q], dy = y - sorted_.y[q], dz = z - sorted_.z[q];
            const bool is_near = dx * dx + dy * dy + dz * dz < reach2_;
            const bool counts = (sorted_.marks[q] & left_out) == 0;
            neighbours[count] = sorted_.atom[q];
            count += static_cast<std::size_t>(is_near & counts);
        }
        count_ = count;
    }

    std::size_t count() const noexcept { return count_; }

private:
    const SortedAtoms& sorted_;
    double reach2_;
    PairList& list_;
    std::size_t count_ = 0;
};

}  // namespace

PairList build_pair_list(const Exclusions& exclusions, double cutoff, double skin,
                         std::span<const Vec3> positions, std::span<const std::uint8_t> is_fixed,
                         PairList storage) {
    PALPA_ASSERT(cutoff > 0 && skin >= 0);
    PALPA_ASSERT(is_fixed.empty() || is_fixed.size() == positions.size());
    PairList list = std::move(storage);
    list.cutoff = cutoff;
    list.skin = skin;
    list.positions.assign(positions.begin(), positions.end());
    const double reach = cutoff + skin;
    // A little more than half, so that rounding cannot put a neighbour three cells away.
    const std::vector<Placed> placed = sort_into_cells(positions, reach / 2 * (1 + 1e-9));
    SortedAtoms sorted = sort_atoms(placed, positions, is_fixed, exclusions);

    list.first.assign(1, 0);
    RowWriter writer(sorted, reach, list);
    RunFinder finder(placed);
    std::array<Run, following_rows.size()> runs{};
    std::size_t own_end = 0;  // of the cells in the atom's own row
    for (std::size_t p = 0; p < placed.size(); ++p) {
        const std::uint64_t cell = placed[p].cell;
        if (p == 0 || cell != placed[p - 1].cell) {
            for (std::size_t which = 0; which < runs.size(); ++which)
                runs[which] = finder.find(which, cell);
            while (own_end < placed.size() && placed[own_end].cell <= cell + reach_cells) ++own_end;
        }
        const auto excluded = std::span(sorted.excluded)
                                  .subspan(sorted.first_excluded[p],
                                           sorted.first_excluded[p + 1] - sorted.first_excluded[p]);
        for (const std::uint32_t q : excluded) sorted.marks[q] |= excluded_mark;
        writer.add(p, {p + 1, own_end});
        for (const Run& run : runs) writer.add(p, run);
        for (const std::uint32_t q : excluded) sorted.marks[q] &= fixed_mark;
        list.first.push_back(writer.count());
    }
    list.neighbours.resize(writer.count());
    list.atoms = std::move(sorted.atom);
    return list;
}

bool is_outdated(const PairList& list, std::span<const Vec3> positions) noexcept {
    PALPA_ASSERT(positions.size() == list.positions.size());
    const double most2 = 0.25 * list.skin * list.skin;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if ((positions[i] - list.positions[i]).squaredNorm() > most2) return true;
    }
    return false;
}

PairRows find_rows(const PairList& list, double from, double to) noexcept {
    const auto row_at = [&](double share) {
        const auto pair =
            static_cast<std::size_t>(share * static_cast<double>(list.neighbours.size()));
        return static_cast<std::size_t>(
            std::lower_bound(list.first.begin(), list.first.end(), pair) - list.first.begin());
    };
    return {from <= 0 ? 0 : row_at(from), to >= 1 ? list.atoms.size() : row_at(to)};
}

}  // namespace palpa
