#include "charmm/cut_sphere.h"

#include "core/assertion.h"

#include <algorithm>
#include <array>
#include <limits>

namespace palpa {
namespace {

constexpr std::uint32_t left_out = std::numeric_limits<std::uint32_t>::max();

struct ResidueDistance {
    std::uint32_t first, next;  // atoms [first, next)
    double square;              // of its nearest atom, Å^2
};

// The residue of `centre` is nearest of all, whatever lies on it.
std::vector<ResidueDistance> find_distances(const Connectivity& connectivity,
                                            std::span<const Vec3> positions, std::uint32_t centre) {
    std::vector<ResidueDistance> residues;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (i == 0 || !is_same_residue(connectivity.names[i - 1], connectivity.names[i])) {
            residues.push_back({i, i, std::numeric_limits<double>::infinity()});
        }
        ResidueDistance& residue = residues.back();
        residue.next = i + 1;
        const double square = i == centre ? -1 : (positions[i] - positions[centre]).squaredNorm();
        residue.square = std::min(residue.square, square);
    }
    return residues;
}

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

std::vector<std::uint32_t> find_sphere(const Connectivity& connectivity,
                                       std::span<const Vec3> positions, std::uint32_t centre,
                                       std::size_t most_atoms) {
    PALPA_ASSERT(positions.size() == connectivity.names.size() && centre < positions.size());
    std::vector<ResidueDistance> residues = find_distances(connectivity, positions, centre);
    std::ranges::stable_sort(residues, {}, &ResidueDistance::square);
    std::vector<std::uint32_t> atoms;
    for (const ResidueDistance& residue : residues) {
        if (!atoms.empty() && atoms.size() + (residue.next - residue.first) > most_atoms) break;
        for (std::uint32_t i = residue.first; i < residue.next; ++i) atoms.push_back(i);
    }
    std::ranges::sort(atoms);
    return atoms;
}

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

CutSystem cut_sphere(const Connectivity& connectivity, const Topology& topology,
                     std::span<const Vec3> positions, std::uint32_t centre,
                     std::size_t most_atoms) {
    CutSystem system;
    system.atoms = find_sphere(connectivity, positions, centre, most_atoms);
    append_atoms(connectivity, system.atoms, system.connectivity);
    system.topology = cut_topology(topology, system.atoms);
    for (const std::uint32_t atom : system.atoms) system.positions.push_back(positions[atom]);
    return system;
}

}  // namespace palpa
