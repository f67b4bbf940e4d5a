#include "charmm/cut_topology.h"

#include "core/assertion.h"

#include <algorithm>
#include <array>
#include <limits>

namespace palpa {
namespace {

constexpr std::uint32_t left_out = std::numeric_limits<std::uint32_t>::max();

// Takes atoms and terms over by their new numbers, those of which all atoms have one.
class TermCut {
public:
    explicit TermCut(std::vector<std::uint32_t> new_index) : new_index_(std::move(new_index)) {}

    std::uint32_t operator[](std::uint32_t atom) const { return new_index_[atom]; }

    // Terms that name their atoms by these members.
    template <class Term, class... Members>
    std::vector<Term> cut(const std::vector<Term>& terms, Members... members) const {
        std::vector<Term> kept;
        for (Term term : terms) {
            if ((renumber(term.*members) && ...)) kept.push_back(term);
        }
        return kept;
    }

    template <std::size_t Count>
    bool renumber(std::array<std::uint32_t, Count>& atoms) const {
        return std::ranges::all_of(atoms, [this](std::uint32_t& atom) { return renumber(atom); });
    }

private:
    bool renumber(std::uint32_t& atom) const {
        atom = new_index_[atom];
        return atom != left_out;
    }

    std::vector<std::uint32_t> new_index_;
};

Exclusions cut_exclusions(const Exclusions& whole, std::span<const std::uint32_t> atoms,
                          const TermCut& cut) {
    Exclusions kept;
    kept.first.push_back(0);
    for (const std::uint32_t atom : atoms) {
        for (const std::uint32_t other : whole.of(atom)) {
            if (cut[other] != left_out) kept.atoms.push_back(cut[other]);
        }
        kept.first.push_back(static_cast<std::uint32_t>(kept.atoms.size()));
    }
    for (std::array<std::uint32_t, 2> pair : whole.pairs14) {
        if (cut.renumber(pair)) kept.pairs14.push_back(pair);
    }
    return kept;
}

std::vector<double> cut_values(const std::vector<double>& whole,
                               std::span<const std::uint32_t> atoms) {
    std::vector<double> kept;
    for (const std::uint32_t atom : atoms) kept.push_back(whole[atom]);
    return kept;
}

Solvation cut_solvation(const Solvation& whole, std::span<const std::uint32_t> atoms) {
    return {cut_values(whole.volume, atoms), cut_values(whole.dg_ref, atoms),
            cut_values(whole.dg_free, atoms), cut_values(whole.lambda, atoms),
            cut_values(whole.radius, atoms)};
}

}  // namespace

Topology cut_topology(const Topology& whole, std::span<const std::uint32_t> atoms) {
    PALPA_ASSERT(std::ranges::is_sorted(atoms));
    std::vector<std::uint32_t> new_index(whole.size(), left_out);
    Topology kept;
    for (const std::uint32_t atom : atoms) {
        new_index[atom] = static_cast<std::uint32_t>(kept.charge.size());
        kept.charge.push_back(whole.charge[atom]);
        kept.type.push_back(whole.type[atom]);
    }
    const TermCut cut(std::move(new_index));
    kept.bonds = cut.cut(whole.bonds, &Bond::a, &Bond::b);
    kept.angles = cut.cut(whole.angles, &Angle::a, &Angle::b, &Angle::c);
    kept.urey_bradleys = cut.cut(whole.urey_bradleys, &UreyBradley::a, &UreyBradley::c);
    kept.dihedrals =
        cut.cut(whole.dihedrals, &Dihedral::a, &Dihedral::b, &Dihedral::c, &Dihedral::d);
    kept.impropers =
        cut.cut(whole.impropers, &Improper::a, &Improper::b, &Improper::c, &Improper::d);
    kept.cmap_terms = cut.cut(whole.cmap_terms, &CmapTerm::phi, &CmapTerm::psi);
    kept.cmap_maps = whole.cmap_maps;
    kept.lennard_jones = whole.lennard_jones;
    kept.lennard_jones14 = whole.lennard_jones14;
    kept.exclusions = cut_exclusions(whole.exclusions, atoms, cut);
    if (whole.solvation) kept.solvation = cut_solvation(*whole.solvation, atoms);
    return kept;
}

}  // namespace palpa
