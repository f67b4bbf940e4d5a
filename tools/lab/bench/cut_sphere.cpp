#include "tools/lab/bench/cut_sphere.h"

#include "charmm/cut_topology.h"
#include "core/assertion.h"

#include <algorithm>
#include <limits>

namespace palpa {
namespace {

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
