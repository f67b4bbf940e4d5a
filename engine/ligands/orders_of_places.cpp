#include "ligands/orders_of_places.h"

#include "ligands/bond_orders.h"
#include "ligands/perception.h"
#include "molecule/element.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

double distance(const MoleculeGraph& graph, const GraphBond& bond) {
    return (*graph.atoms[bond.a].position - *graph.atoms[bond.b].position).norm();
}

double angle_deg(const MoleculeGraph& graph, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3 one = *graph.atoms[a].position - *graph.atoms[b].position;
    const Vec3 other = *graph.atoms[c].position - *graph.atoms[b].position;
    const double cosine = one.dot(other) / std::max(one.norm() * other.norm(), 1e-9);
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

// How far the atoms of a ring are from its plane through the middle, Å, at most.
double flatness(const MoleculeGraph& graph, const std::vector<std::uint32_t>& ring) {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t atom : ring) middle += *graph.atoms[atom].position;
    middle /= static_cast<double>(ring.size());
    Vec3 normal = Vec3::Zero();
    for (std::size_t i = 0; i < ring.size(); ++i) {
        normal += (*graph.atoms[ring[i]].position - middle)
                      .cross(*graph.atoms[ring[(i + 1) % ring.size()]].position - middle);
    }
    normal.normalize();
    double most = 0;
    for (const std::uint32_t atom : ring) {
        most = std::max(most, std::abs(normal.dot(*graph.atoms[atom].position - middle)));
    }
    return most;
}

// A bond between these elements that is shorter may be double, Å: halfway between the usual single
// and aromatic or amide lengths.
double longest_double(std::string_view a, std::string_view b) {
    if (b < a) std::swap(a, b);
    if (a == "C" && b == "C") return 1.46;
    if (a == "C" && b == "N") return 1.42;
    if (a == "C" && b == "O") return 1.32;
    if (a == "C" && b == "S") return 1.72;
    if (a == "N" && b == "N") return 1.38;
    if (a == "N" && b == "O") return 1.30;
    return 0;
}

class OrderGuess {
public:
    explicit OrderGuess(MoleculeGraph& graph)
        : graph_(graph),
          bonds_(bonds_of_atoms(graph)),
          is_in_flat_ring_(graph.size()),
          is_flat_ring_bond_(graph.bonds.size()) {
        for (const auto& ring : find_rings(graph)) {
            if (ring.size() < 5 || ring.size() > 6 || flatness(graph, ring) > 0.12) continue;
            // A saturated ring of five may be flat by chance; its bonds are long.
            if (ring.size() == 5 && mean_excess(ring) > 0) continue;
            for (const std::uint32_t atom : ring) is_in_flat_ring_[atom] = true;
        }
        for (std::size_t i = 0; i < graph.bonds.size(); ++i) {
            is_flat_ring_bond_[i] =
                is_in_flat_ring_[graph.bonds[i].a] && is_in_flat_ring_[graph.bonds[i].b];
        }
    }

    // What is plain first: C=O, S=O and P=O; then rings; then chains with the rest.
    void guess() {
        valence_.resize(graph_.size());
        for (std::uint32_t i = 0; i < graph_.size(); ++i) valence_[i] = open_at(i);
        pair([&](std::size_t i) { return is_oxo(graph_.bonds[i]); });
        charge_pyridinium();
        pair([&](std::size_t i) { return is_flat_ring_bond_[i]; });
        pair([&](std::size_t i) { return is_short(graph_.bonds[i]); });
    }

private:
    // Pairs what is still open along some of the bonds.
    template <class May>
    void pair(const May& may) {
        std::vector<int> open = valence_;
        for (const GraphBond& bond : graph_.bonds) {
            open[bond.a] -= bond.order - 1;
            open[bond.b] -= bond.order - 1;
        }
        std::vector<bool> marked;
        for (std::size_t i = 0; i < graph_.bonds.size(); ++i) marked.push_back(may(i));
        (void)pair_marked_bonds(graph_, marked, open);
    }

    // A flat ring of five carbons and a nitrogen with three neighbours, nothing double on it.
    void charge_pyridinium() {
        for (const auto& ring : find_rings(graph_)) {
            std::optional<std::uint32_t> nitrogen;
            bool is_one = ring.size() == 6;
            std::size_t carbons = 0;
            for (const std::uint32_t atom : ring) {
                if (element(atom) == "C") ++carbons;
                if (element(atom) == "N" && bonds_[atom].size() == 3) nitrogen = atom;
                is_one = is_one && is_in_flat_ring_[atom];
                for (const std::uint32_t i : bonds_[atom]) {
                    is_one = is_one && graph_.bonds[i].order == 1;
                }
            }
            if (!is_one || carbons != 5 || !nitrogen) continue;
            valence_[*nitrogen] = 1;
            graph_.atoms[*nitrogen].charge = 1;
        }
    }

    // To an oxygen of one neighbour. 1.32 Å lies between C=O and C-OH; amides of loosely refined
    // structures reach beyond.
    bool is_oxo(const GraphBond& bond) const {
        for (const auto& [end, centre] : {std::pair(bond.a, bond.b), std::pair(bond.b, bond.a)}) {
            if (element(end) != "O" || bonds_[end].size() != 1) continue;
            if (element(centre) == "S" || element(centre) == "P" || element(centre) == "N") {
                return true;
            }
            const double limit = is_in_flat_ring_[centre] ? 1.30 : 1.34;
            return element(centre) == "C" && distance(graph_, bond) < limit;
        }
        return false;
    }

    bool is_short(const GraphBond& bond) const {
        if (element(bond.a) == "S" || element(bond.b) == "S" || element(bond.a) == "P" ||
            element(bond.b) == "P") {
            return is_hypervalent(bond.a) || is_hypervalent(bond.b)
                       ? false
                       : distance(graph_, bond) < longest_double(element(bond.a), element(bond.b));
        }
        // Anilines: their nitrogen's bond is short as well.
        const bool leaves_ring = is_in_flat_ring_[bond.a] != is_in_flat_ring_[bond.b];
        return distance(graph_, bond) <
               longest_double(element(bond.a), element(bond.b)) - (leaves_ring ? 0.1 : 0);
    }

    const std::string& element(std::uint32_t atom) const { return graph_.atoms[atom].element; }

    double mean_excess(const std::vector<std::uint32_t>& ring) const {
        double sum = 0;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
            sum += (*graph_.atoms[a].position - *graph_.atoms[b].position).norm() -
                   std::max(longest_double(element(a), element(b)), 1.36);
        }
        return sum;
    }

    std::size_t terminal_oxygens(std::uint32_t atom) const {
        return static_cast<std::size_t>(
            std::count_if(bonds_[atom].begin(), bonds_[atom].end(), [&](std::uint32_t i) {
                const std::uint32_t other = other_end(graph_.bonds[i], atom);
                return element(other) == "O" && bonds_[other].size() == 1;
            }));
    }

    bool is_hypervalent(std::uint32_t atom) const {
        return (element(atom) == "S" || element(atom) == "P") && bonds_[atom].size() > 2;
    }

    std::uint32_t neighbour(std::uint32_t atom, std::size_t i) const {
        return other_end(graph_.bonds[bonds_[atom][i]], atom);
    }

    bool is_flat(std::uint32_t atom) const {
        if (is_in_flat_ring_[atom]) return true;
        if (bonds_[atom].size() == 3) {
            const std::uint32_t a = neighbour(atom, 0), b = neighbour(atom, 1),
                                c = neighbour(atom, 2);
            return angle_deg(graph_, a, atom, b) + angle_deg(graph_, b, atom, c) +
                       angle_deg(graph_, c, atom, a) >
                   353;
        }
        if (bonds_[atom].size() == 2) {
            return angle_deg(graph_, neighbour(atom, 0), atom, neighbour(atom, 1)) >
                   (element(atom) == "N" ? 108 : 117);
        }
        return true;
    }

    int open_at(std::uint32_t atom) const {
        const std::string& of = element(atom);
        const std::size_t degree = bonds_[atom].size();
        if (of == "S" || of == "P") {
            if (degree == 4) return of == "S" ? 2 : 1;
            return of == "S" && degree == 3 && terminal_oxygens(atom) > 0 ? 1 : 0;
        }
        if (of == "O") return degree == 1 ? 1 : 0;
        if (of == "N") {
            if (degree == 3) return terminal_oxygens(atom) == 2 ? 1 : 0;
            return degree < 3 && is_flat(atom) ? is_linear_end(atom) ? 2 : 1 : 0;
        }
        if (of != "C" || degree > 3 || !is_flat(atom)) return 0;
        return is_linear(atom) || is_linear_end(atom) ? 2 : 1;
    }

    bool is_linear(std::uint32_t atom) const {
        return bonds_[atom].size() == 2 &&
               angle_deg(graph_, neighbour(atom, 0), atom, neighbour(atom, 1)) > 160;
    }

    bool is_linear_end(std::uint32_t atom) const {
        return bonds_[atom].size() == 1 && is_linear(neighbour(atom, 0)) &&
               distance(graph_, graph_.bonds[bonds_[atom][0]]) < 1.25;
    }

    MoleculeGraph& graph_;
    BondLists bonds_;
    std::vector<bool> is_in_flat_ring_, is_flat_ring_bond_;
    std::vector<int> valence_;  // what single bonds leave open, of each atom
};

}  // namespace

void find_bonds(MoleculeGraph& graph) {
    graph.bonds.clear();
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        if (graph.is_hydrogen(i) || !graph.atoms[i].position) continue;
        for (std::uint32_t j = i + 1; j < graph.size(); ++j) {
            if (graph.is_hydrogen(j) || !graph.atoms[j].position) continue;
            const double reach = covalent_radius(graph.atoms[i].element) +
                                 covalent_radius(graph.atoms[j].element) + 0.4;
            if ((*graph.atoms[i].position - *graph.atoms[j].position).norm() < reach) {
                graph.bonds.push_back({i, j, 1});
            }
        }
    }
    for (std::uint32_t h = 0; h < graph.size(); ++h) {
        if (!graph.is_hydrogen(h) || !graph.atoms[h].position) continue;
        double nearest = 1.5;
        std::optional<std::uint32_t> parent;
        for (std::uint32_t i = 0; i < graph.size(); ++i) {
            if (graph.is_hydrogen(i) || !graph.atoms[i].position) continue;
            const double gap = (*graph.atoms[i].position - *graph.atoms[h].position).norm();
            if (gap >= nearest) continue;
            nearest = gap;
            parent = i;
        }
        if (parent) graph.bonds.push_back({*parent, h, 1});
    }
}

void guess_orders(MoleculeGraph& graph) {
    // Shortest bonds are tried first.
    std::stable_sort(
        graph.bonds.begin(), graph.bonds.end(), [&](const GraphBond& a, const GraphBond& b) {
            const auto excess = [&](const GraphBond& bond) {
                return distance(graph, bond) - covalent_radius(graph.atoms[bond.a].element) -
                       covalent_radius(graph.atoms[bond.b].element);
            };
            return excess(a) < excess(b);
        });
    OrderGuess(graph).guess();
}

}  // namespace palpa
