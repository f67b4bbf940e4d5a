#include "molecule/backbone_bonds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

constexpr double farthest_alphas = 9;  // Å; N-H and O=C of residues farther apart have no bond
constexpr double farthest = 6;         // Å, from N to O; there a straight bond has -0.3 kcal/mol
constexpr double weakest = -0.5, strongest = -9.9;  // kcal/mol

// Atoms CA by cells as wide as what is near, sorted: neighbours along z stand behind each other.
class Cells {
public:
    explicit Cells(std::span<const BackboneResidue> residues) {
        for (std::size_t i = 0; i < residues.size(); ++i)
            entries_.push_back({cell_of(residues[i].alpha), residues[i].alpha, i});
        std::ranges::sort(entries_, {}, &Entry::cell);
    }

    // Calls with every two residues whose CA are near, once, the lower number first.
    template <class Visit>
    void each_pair(Visit visit) const {
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            const Cell& cell = entries_[i].cell;
            for (std::size_t k = i + 1; k < entries_.size(); ++k) {
                const Cell& other = entries_[k].cell;
                if (other[0] != cell[0] || other[1] != cell[1] || other[2] > cell[2] + 1) break;
                visit_near(entries_[i], entries_[k], visit);
            }
        }
        for (const auto& [dx, dy] : {std::pair(0, 1), {1, -1}, {1, 0}, {1, 1}})
            each_pair_at(dx, dy, visit);
    }

private:
    using Cell = std::array<double, 3>;
    struct Entry {
        Cell cell;
        Vec3 alpha;
        std::size_t residue;
    };

    static Cell cell_of(const Vec3& place) {
        const Vec3 cell = (place / farthest_alphas).array().floor();
        return {cell.x(), cell.y(), cell.z()};
    }

    // Both ends of what is near move on with the entries.
    template <class Visit>
    void each_pair_at(int dx, int dy, Visit& visit) const {
        auto begin = entries_.begin(), end = begin;
        for (const Entry& entry : entries_) {
            const auto& [x, y, z] = entry.cell;
            const Cell first{x + dx, y + dy, z - 1}, last{x + dx, y + dy, z + 1};
            while (begin != entries_.end() && begin->cell < first) ++begin;
            end = std::max(end, begin);
            while (end != entries_.end() && end->cell <= last) ++end;
            for (auto other = begin; other != end; ++other) visit_near(entry, *other, visit);
        }
    }

    template <class Visit>
    static void visit_near(const Entry& a, const Entry& b, Visit& visit) {
        if ((a.alpha - b.alpha).squaredNorm() > farthest_alphas * farthest_alphas) return;
        visit(std::min(a.residue, b.residue), std::max(a.residue, b.residue));
    }

    std::vector<Entry> entries_;
};

std::optional<Vec3> find_hydrogen(std::span<const BackboneResidue> residues, std::size_t i) {
    const BackboneResidue& residue = residues[i];
    if (i == 0 || !residue.follows || residue.is_proline) return std::nullopt;
    return residue.n + (residues[i - 1].c - residues[i - 1].o).normalized();
}

}  // namespace

bool is_peptide_bond(const Vec3& c, const Vec3& n) noexcept {
    constexpr double longest = 2.5;  // Å
    return (c - n).squaredNorm() <= longest * longest;
}

double backbone_bond_energy(const Vec3& n, const Vec3& h, const Vec3& c, const Vec3& o) noexcept {
    constexpr double closest = 0.5;  // Å
    const double on = (o - n).norm(), ch = (c - h).norm(), oh = (o - h).norm(), cn = (c - n).norm();
    if (std::min({on, ch, oh, cn}) < closest) return strongest;
    return std::max(27.9 * (1 / on + 1 / ch - 1 / oh - 1 / cn), strongest);
}

BackboneBonds::BackboneBonds(std::span<const BackboneResidue> residues) : donors_(residues.size()) {
    std::vector<std::optional<Vec3>> hydrogens;
    for (std::size_t i = 0; i < residues.size(); ++i)
        hydrogens.push_back(find_hydrogen(residues, i));

    const auto try_bond = [&](std::size_t donor, std::size_t acceptor) {
        const auto& [n, h] = std::tie(residues[donor].n, hydrogens[donor]);
        const Vec3& o = residues[acceptor].o;
        if (!h || (n - o).squaredNorm() > farthest * farthest) return;
        add(donor, acceptor, backbone_bond_energy(n, *h, residues[acceptor].c, o));
    };
    Cells(residues).each_pair([&](std::size_t i, std::size_t j) {
        try_bond(i, j);
        if (j != i + 1) try_bond(j, i);  // else they share a peptide bond, or j has no hydrogen
    });
}

bool BackboneBonds::has(std::ptrdiff_t donor, std::ptrdiff_t acceptor) const noexcept {
    return donor >= 0 && donor < std::ssize(donors_) &&
           std::ranges::find(acceptors(donor), acceptor) != acceptors(donor).end();
}

std::span<const std::ptrdiff_t> BackboneBonds::acceptors(std::ptrdiff_t donor) const noexcept {
    const Donor& found = donors_[static_cast<std::size_t>(donor)];
    return std::span(found.acceptors).first(found.count);
}

void BackboneBonds::add(std::size_t donor, std::size_t acceptor, double energy) {
    if (!(energy < weakest)) return;
    auto& [acceptors, energies, count] = donors_[donor];
    const auto place = static_cast<std::size_t>(
        std::upper_bound(energies.begin(), energies.begin() + static_cast<std::ptrdiff_t>(count),
                         energy) -
        energies.begin());
    if (place == energies.size()) return;
    if (place == 0) {
        energies[1] = energies[0];
        acceptors[1] = acceptors[0];
    }
    energies[place] = energy;
    acceptors[place] = static_cast<std::ptrdiff_t>(acceptor);
    count = std::min(count + 1, energies.size());
}

}  // namespace palpa
