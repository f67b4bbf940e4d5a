#include "view/pocket.h"

#include "molecule/atoms.h"
#include "molecule/point_grid.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "view/in_hand.h"

#include <algorithm>
#include <cstddef>

namespace palpa {
namespace {

constexpr double near_by = 4.5;  // Å

// Of one molecule: another one beside it may have the same names.
void add_residues(const AtomTable& atoms, AtomRange range, std::vector<ResidueSpan>& residues) {
    const std::size_t end = range.first + range.count;
    for (std::size_t first = range.first; first < end;) {
        ResidueSpan residue{first, first + 1, 0};
        while (residue.end < end && is_same_residue(atoms.names[residue.end], atoms.names[first]))
            ++residue.end;
        residue.alpha = residue.end;
        for (std::size_t i = first; i < residue.end; ++i) {
            const bool is_calcium = residue.end - first == 1;
            if (atoms.names[i].atom == "CA" && !is_calcium) residue.alpha = i;
        }
        residues.push_back(residue);
        first = residue.end;
    }
}

}  // namespace

std::vector<ResidueSpan> find_residues(const World& world) {
    const AtomTable& atoms = world.resource<AtomTable>();
    std::vector<ResidueSpan> residues;
    world.each<Molecule>(
        [&](Entity, const Molecule& molecule) { add_residues(atoms, molecule.atoms, residues); });
    return residues;
}

std::vector<bool> find_pocket(const World& world, std::span<const ResidueSpan> residues) {
    const std::vector<Vec3>& places = world.resource<AtomTable>().positions;
    const std::vector<bool> held = find_held_atoms(world);
    std::vector<Vec3> in_hand;
    for (std::size_t i = 0; i < held.size(); ++i)
        if (held[i]) in_hand.push_back(places[i]);
    const PointGrid grid(in_hand);
    std::vector<bool> near(places.size(), false);
    for (const ResidueSpan& residue : residues) {
        bool is_near = false;
        for (std::size_t i = residue.first; i < residue.end && !is_near; ++i)
            is_near = !held[i] && grid.has_near(places[i], near_by);
        for (std::size_t i = residue.first; i < residue.end; ++i) near[i] = is_near && !held[i];
    }
    return near;
}

}  // namespace palpa
