#include "ligands/perception.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>

namespace palpa {
namespace {

using Ring = std::vector<std::uint32_t>;

// The shortest way from one neighbour of `centre` to another that avoids it; breadth first, with
// `largest_ring` atoms in all. Empty: none.
Ring find_ring(const MoleculeGraph& graph, const BondLists& bonds, std::uint32_t centre,
               std::uint32_t from, std::uint32_t to) {
    std::vector<std::vector<std::uint32_t>> ways{{centre, from}};
    std::set<std::uint32_t> seen{centre, from};
    while (!ways.empty() && ways.front().size() < largest_ring) {
        std::vector<std::vector<std::uint32_t>> longer;
        for (const auto& way : ways) {
            for (const std::uint32_t bond : bonds[way.back()]) {
                const std::uint32_t next = other_end(graph.bonds[bond], way.back());
                if (next == centre || (next != to && !seen.insert(next).second)) continue;
                longer.push_back(way);
                longer.back().push_back(next);
                if (next == to) return longer.back();
            }
        }
        ways = std::move(longer);
    }
    return {};
}

bool has_double_in_ring(const MoleculeGraph& graph, const Perceived& seen, std::uint32_t atom) {
    return std::any_of(seen.bonds[atom].begin(), seen.bonds[atom].end(), [&](std::uint32_t i) {
        return graph.bonds[i].order == 2 && seen.bond_in_ring[i];
    });
}

// The pi electrons that an atom gives to a ring; -1: it interrupts the ring.
int pi_electrons(const MoleculeGraph& graph, const Perceived& seen, std::uint32_t atom) {
    const GraphAtom& a = graph.atoms[atom];
    if (has_double_in_ring(graph, seen, atom)) return 1;
    const std::size_t degree = seen.bonds[atom].size();
    if (a.element == "C" && degree == 3) {
        const bool is_carbonyl =
            std::any_of(seen.bonds[atom].begin(), seen.bonds[atom].end(), [&](std::uint32_t i) {
                const std::string& other = graph.atoms[other_end(graph.bonds[i], atom)].element;
                return graph.bonds[i].order == 2 && other != "C";
            });
        if (is_carbonyl) return 0;
        return a.charge == -1 ? 2 : -1;
    }
    if (a.element == "N" && (degree == 3 || (degree == 2 && a.charge == -1))) return 2;
    if ((a.element == "O" || a.element == "S" || a.element == "SE") && degree == 2) return 2;
    return -1;
}

bool is_aromatic_ring(const MoleculeGraph& graph, const Perceived& seen, const Ring& ring) {
    if (ring.size() < 5) return false;
    int electrons = 0;
    for (const std::uint32_t atom : ring) {
        const int own = pi_electrons(graph, seen, atom);
        if (own < 0) return false;
        electrons += own;
    }
    return electrons % 4 == 2;
}

void mark_ring_bonds(const MoleculeGraph& graph, const Ring& ring, const BondLists& bonds,
                     std::vector<bool>& marked) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t next = ring[(i + 1) % ring.size()];
        for (const std::uint32_t bond : bonds[ring[i]]) {
            if (other_end(graph.bonds[bond], ring[i]) == next) marked[bond] = true;
        }
    }
}

void share_charge(const std::vector<std::uint32_t>& atoms, std::vector<double>& charge) {
    double sum = 0;
    for (const std::uint32_t atom : atoms) sum += charge[atom];
    for (const std::uint32_t atom : atoms) charge[atom] = sum / static_cast<double>(atoms.size());
}

// Ends of one element around `centre` that differ in the Kekulé form alone.
void find_equal_ends(const MoleculeGraph& graph, std::uint32_t centre, Perceived& seen) {
    for (const char* const element : {"O", "S"}) {
        std::vector<std::uint32_t> ends, bonds;
        bool has_single = false, has_double = false;
        for (const std::uint32_t i : seen.bonds[centre]) {
            const std::uint32_t end = other_end(graph.bonds[i], centre);
            if (graph.atoms[end].element != element || seen.bonds[end].size() != 1) continue;
            ends.push_back(end);
            bonds.push_back(i);
            (graph.bonds[i].order == 1 ? has_single : has_double) = true;
        }
        if (!has_single || !has_double) continue;
        share_charge(ends, seen.charge);
        for (const std::uint32_t i : bonds) seen.kinds[i] = BondKind::Resonance;
    }
}

// A carbon with N+ on a double bond, and nitrogens on single ones, outside of an aromatic ring: all
// of these nitrogens are alike.
void find_amidinium(const MoleculeGraph& graph, std::uint32_t centre, Perceived& seen) {
    if (graph.atoms[centre].element != "C" || seen.is_aromatic[centre]) return;
    std::vector<std::uint32_t> nitrogens, bonds;
    bool has_cation = false;
    for (const std::uint32_t i : seen.bonds[centre]) {
        const std::uint32_t end = other_end(graph.bonds[i], centre);
        if (graph.atoms[end].element != "N" || seen.bonds[end].size() != 3) continue;
        nitrogens.push_back(end);
        bonds.push_back(i);
        has_cation = has_cation || (graph.bonds[i].order == 2 && graph.atoms[end].charge == 1);
    }
    if (!has_cation || nitrogens.size() < 2) return;
    share_charge(nitrogens, seen.charge);
    for (const std::uint32_t i : bonds) seen.kinds[i] = BondKind::Resonance;
}

// The nitrogens of an imidazolium.
void share_in_ring(const MoleculeGraph& graph, const Ring& ring, Perceived& seen) {
    if (ring.size() != 5) return;
    std::vector<std::uint32_t> nitrogens;
    double charge = 0;
    for (const std::uint32_t atom : ring) {
        if (graph.atoms[atom].element != "N" || seen.bonds[atom].size() != 3) continue;
        nitrogens.push_back(atom);
        charge += graph.atoms[atom].charge;
    }
    if (nitrogens.size() >= 2 && charge > 0) share_charge(nitrogens, seen.charge);
}

}  // namespace

std::vector<Ring> find_rings(const MoleculeGraph& graph) {
    const BondLists bonds = bonds_of_atoms(graph);
    std::set<Ring> known;
    std::vector<Ring> rings;
    for (std::uint32_t centre = 0; centre < graph.size(); ++centre) {
        for (std::size_t i = 0; i < bonds[centre].size(); ++i) {
            for (std::size_t j = i + 1; j < bonds[centre].size(); ++j) {
                const Ring ring = find_ring(graph, bonds, centre,
                                            other_end(graph.bonds[bonds[centre][i]], centre),
                                            other_end(graph.bonds[bonds[centre][j]], centre));
                if (ring.empty()) continue;
                Ring sorted = ring;
                std::sort(sorted.begin(), sorted.end());
                if (known.insert(sorted).second) rings.push_back(ring);
            }
        }
    }
    return rings;
}

Perceived perceive(const MoleculeGraph& graph) {
    Perceived seen;
    seen.bonds = bonds_of_atoms(graph);
    seen.rings = find_rings(graph);
    seen.in_ring_of.resize(graph.size());
    seen.is_aromatic.resize(graph.size());
    seen.bond_in_ring.resize(graph.bonds.size());
    for (const Ring& ring : seen.rings) {
        mark_ring_bonds(graph, ring, seen.bonds, seen.bond_in_ring);
        for (const std::uint32_t atom : ring) seen.in_ring_of[atom][ring.size()] = true;
    }
    for (const GraphBond& bond : graph.bonds) {
        seen.kinds.push_back(bond.order == 1   ? BondKind::Single
                             : bond.order == 2 ? BondKind::Double
                                               : BondKind::Triple);
    }
    for (const GraphAtom& atom : graph.atoms) seen.charge.push_back(atom.charge);
    std::vector<bool> aromatic_bonds(graph.bonds.size());
    for (const Ring& ring : seen.rings) {
        seen.ring_is_aromatic.push_back(is_aromatic_ring(graph, seen, ring));
        if (!seen.ring_is_aromatic.back()) continue;
        mark_ring_bonds(graph, ring, seen.bonds, aromatic_bonds);
        for (const std::uint32_t atom : ring) seen.is_aromatic[atom] = true;
        share_in_ring(graph, ring, seen);
    }
    for (std::size_t i = 0; i < graph.bonds.size(); ++i) {
        if (aromatic_bonds[i]) seen.kinds[i] = BondKind::Aromatic;
    }
    for (std::uint32_t atom = 0; atom < graph.size(); ++atom) {
        find_equal_ends(graph, atom, seen);
        find_amidinium(graph, atom, seen);
    }
    return seen;
}

}  // namespace palpa
