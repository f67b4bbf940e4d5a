#include "molecule/secondary_structure.h"

#include "molecule/backbone_bonds.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

namespace palpa {
namespace {

using Number = std::ptrdiff_t;  // of a residue
using enum SecondaryStructure;

// Of every residue, the number of breaks in the chain before it.
class Chains {
public:
    explicit Chains(std::span<const BackboneResidue> residues) {
        Number piece = 0;
        for (const BackboneResidue& residue : residues) {
            if (!residue.follows) ++piece;
            pieces_.push_back(piece);
        }
    }

    // Whether both are there, and bonds lead from one to the other.
    bool joins(Number first, Number last) const {
        return first >= 0 && last < std::ssize(pieces_) && piece(first) == piece(last);
    }
    Number piece(Number i) const { return pieces_[static_cast<std::size_t>(i)]; }

private:
    std::vector<Number> pieces_;
};

// Two rows of residues side by side, each by its first and last.
struct Ladder {
    bool parallel;
    Number first, last;              // of the row that comes first in the chains
    Number other_first, other_last;  // of its partners
    std::size_t bridges = 1;
};

enum class Bridging { None, Parallel, Antiparallel };

Bridging find_bridging(const BackboneBonds& bonds, const Chains& chains, Number i, Number j) {
    if (!chains.joins(i - 1, i + 1) || !chains.joins(j - 1, j + 1)) return Bridging::None;
    const auto bonded = [&](Number donor, Number acceptor) { return bonds.has(donor, acceptor); };
    if ((bonded(i + 1, j) && bonded(j, i - 1)) || (bonded(j + 1, i) && bonded(i, j - 1)))
        return Bridging::Parallel;
    if ((bonded(i + 1, j - 1) && bonded(j + 1, i - 1)) || (bonded(j, i) && bonded(i, j)))
        return Bridging::Antiparallel;
    return Bridging::None;
}

// Pairs of residues that could be bridges, the earlier first, in order: each kind of bridge has one
// of these bonds.
std::vector<std::pair<Number, Number>> find_candidates(const BackboneBonds& bonds, Number count) {
    std::vector<std::pair<Number, Number>> pairs;
    const auto add = [&](Number a, Number b) {
        if (std::abs(a - b) >= 3) pairs.emplace_back(std::minmax(a, b));
    };
    for (Number donor = 0; donor < count; ++donor) {
        for (const Number acceptor : bonds.acceptors(donor)) {
            add(donor - 1, acceptor);
            add(donor - 1, acceptor + 1);
            add(donor, acceptor);
        }
    }
    std::ranges::sort(pairs);
    pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
    return pairs;
}

// Whether the bridge of these two is the ladder's next.
bool goes_on(const Ladder& ladder, bool parallel, Number i, Number j) {
    return ladder.parallel == parallel && ladder.last + 1 == i &&
           (parallel ? ladder.other_last + 1 == j : ladder.other_first - 1 == j);
}

std::vector<Ladder> find_ladders(const BackboneBonds& bonds, const Chains& chains, Number count) {
    std::vector<Ladder> ladders;
    for (const auto& [i, j] : find_candidates(bonds, count)) {
        const Bridging bridging = find_bridging(bonds, chains, i, j);
        if (bridging == Bridging::None) continue;
        const bool parallel = bridging == Bridging::Parallel;
        const auto found = std::ranges::find_if(
            ladders, [&](const Ladder& ladder) { return goes_on(ladder, parallel, i, j); });
        if (found == ladders.end()) {
            ladders.push_back({parallel, i, i, j, j});
        } else {
            found->last = i;
            (parallel ? found->other_last : found->other_first) = j;
            ++found->bridges;
        }
    }
    return ladders;
}

// Whether at most a bulge is between two ladders, `b` behind `a`: at most one residue more in one
// row and four in the other.
bool is_bulge(const Ladder& a, const Ladder& b, const Chains& chains) {
    if (a.parallel != b.parallel || b.first <= a.last) return false;
    const Number gap = b.first - a.last;
    const Number other_gap =
        a.parallel ? b.other_first - a.other_last : a.other_first - b.other_last;
    if (gap >= 6 || other_gap < 0) return false;
    if (!((other_gap < 6 && gap < 3) || other_gap < 3)) return false;
    return chains.joins(a.first, b.last) && chains.joins(std::min(a.other_first, b.other_first),
                                                         std::max(a.other_last, b.other_last));
}

void join_bulges(std::vector<Ladder>& ladders, const Chains& chains) {
    std::ranges::sort(ladders, {}, [&](const Ladder& ladder) {
        return std::pair(chains.piece(ladder.first), ladder.first);
    });
    for (std::size_t i = 0; i < ladders.size(); ++i) {
        for (std::size_t j = i + 1; j < ladders.size(); ++j) {
            Ladder &a = ladders[i], &b = ladders[j];
            if (b.bridges == 0 || a.bridges == 0 || !is_bulge(a, b, chains)) continue;
            a.last = b.last;
            (a.parallel ? a.other_last : a.other_first) = a.parallel ? b.other_last : b.other_first;
            a.bridges += std::exchange(b.bridges, 0);
        }
    }
    std::erase_if(ladders, [](const Ladder& ladder) { return ladder.bridges == 0; });
}

using Classes = std::vector<SecondaryStructure>;

std::span<SecondaryStructure> part(Classes& classes, Number first, Number count) {
    return std::span(classes).subspan(static_cast<std::size_t>(first),
                                      static_cast<std::size_t>(count));
}

// What is between the bridges of a ladder, in bulges, is its strand as well.
void mark_strands(std::span<const Ladder> ladders, Classes& classes) {
    for (const Ladder& ladder : ladders) {
        const auto mark = [&](Number first, Number last) {
            for (SecondaryStructure& each : part(classes, first, last - first + 1))
                if (each != Strand) each = ladder.bridges > 1 ? Strand : Bridge;
        };
        mark(ladder.first, ladder.last);
        mark(ladder.other_first, ladder.other_last);
    }
}

// Two turns of a kind behind each other begin a helix, unless some of its residues are of another
// kind than these.
void mark_helices(const BackboneBonds& bonds, const Chains& chains, Number stride,
                  SecondaryStructure helix, std::span<const SecondaryStructure> replaced,
                  Classes& classes) {
    const auto is_turn = [&](Number i) {
        return chains.joins(i, i + stride) && bonds.has(i + stride, i);
    };
    for (Number i = 1; i + stride < std::ssize(classes); ++i) {
        if (!is_turn(i) || !is_turn(i - 1)) continue;
        const std::span<SecondaryStructure> residues = part(classes, i, stride);
        const auto is_free = [&](SecondaryStructure each) {
            return each == helix || std::ranges::find(replaced, each) != replaced.end();
        };
        if (std::ranges::all_of(residues, is_free)) std::ranges::fill(residues, helix);
    }
}

}  // namespace

std::vector<SecondaryStructure> find_secondary_structure(
    std::span<const BackboneResidue> residues) {
    const Chains chains(residues);
    const BackboneBonds bonds(residues);
    std::vector<Ladder> ladders = find_ladders(bonds, chains, std::ssize(residues));
    join_bulges(ladders, chains);

    Classes classes(residues.size(), Coil);
    mark_strands(ladders, classes);
    mark_helices(bonds, chains, 4, AlphaHelix, std::array{Coil, Strand, Bridge}, classes);
    mark_helices(bonds, chains, 3, ThreeTenHelix, std::array{Coil}, classes);
    mark_helices(bonds, chains, 5, PiHelix, std::array{Coil, AlphaHelix}, classes);
    return classes;
}

std::span<const SecondaryStructure> SecondaryStructureCache::update(
    std::span<const BackboneResidue> residues) {
    if (times_found_ == 0 || !is_as_found(residues)) {
        residues_.assign(residues.begin(), residues.end());
        classes_ = find_secondary_structure(residues);
        ++times_found_;
    }
    return classes_;
}

bool SecondaryStructureCache::is_as_found(
    std::span<const BackboneResidue> residues) const noexcept {
    constexpr double far = 0.5;  // Å
    return std::ranges::equal(residues, residues_, [](const auto& now, const auto& found) {
        return now.follows == found.follows && now.is_proline == found.is_proline &&
               (now.alpha - found.alpha).squaredNorm() < far * far &&
               (now.o - found.o).squaredNorm() < far * far;
    });
}

}  // namespace palpa
