#include "ligands/bond_orders.h"

#include "ligands/perception.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace palpa {
namespace {

// Pairs what valences leave open along bonds. Once an atom is satisfied it stays so: each search is
// an augmenting path, which ends at another open atom.
class Pairing {
public:
    Pairing(MoleculeGraph& graph, std::vector<int> open, std::vector<bool> may_rise)
        : graph_(graph),
          bonds_(bonds_of_atoms(graph)),
          open_(std::move(open)),
          may_rise_(std::move(may_rise)),
          is_used_(graph.bonds.size(), false) {}

    int open(std::size_t atom) const noexcept { return open_[atom]; }
    void set_open(std::size_t atom, int open) noexcept { open_[atom] = open; }

    // Takes all that can be paired from this atom.
    void satisfy(std::uint32_t atom) {
        while (open_[atom] > 0) {
            --open_[atom];
            steps_ = 0;
            if (raise_from(atom)) continue;
            ++open_[atom];
            return;
        }
    }

private:
    // An order of a bond of `atom` rises, and its other end is open or lets another bond go.
    bool raise_from(std::uint32_t atom) {
        if (++steps_ > most_steps) return false;
        // Oxygen last: a negative charge belongs there before it does to carbon or nitrogen.
        for (const bool takes_oxygen : {false, true}) {
            for (const std::uint32_t i : bonds_[atom]) {
                GraphBond& bond = graph_.bonds[i];
                if (is_used_[i] || !may_rise_[i] || bond.order >= 3) continue;
                const std::uint32_t other = other_end(bond, atom);
                if (open_[other] == 0 || (graph_.atoms[other].element == "O") != takes_oxygen) {
                    continue;
                }
                --open_[other];
                ++bond.order;
                return true;
            }
        }
        for (const std::uint32_t i : bonds_[atom]) {
            GraphBond& bond = graph_.bonds[i];
            if (is_used_[i] || !may_rise_[i] || bond.order >= 3) continue;
            is_used_[i] = true;
            const bool found = lower_from(other_end(bond, atom));
            is_used_[i] = false;
            if (!found) continue;
            ++bond.order;
            return true;
        }
        return false;
    }

    bool lower_from(std::uint32_t atom) {
        for (const std::uint32_t i : bonds_[atom]) {
            GraphBond& bond = graph_.bonds[i];
            if (is_used_[i] || !may_rise_[i] || bond.order < 2) continue;
            is_used_[i] = true;
            const bool found = raise_from(other_end(bond, atom));
            is_used_[i] = false;
            if (!found) continue;
            --bond.order;
            return true;
        }
        return false;
    }

    static constexpr int most_steps = 5'000;  // of one search; those of drugs take some tens
    MoleculeGraph& graph_;
    BondLists bonds_;
    std::vector<int> open_;
    std::vector<bool> may_rise_, is_used_;
    int steps_ = 0;
};

std::size_t terminal_oxygens(const MoleculeGraph& graph, const BondLists& bonds,
                             std::uint32_t atom) {
    return static_cast<std::size_t>(
        std::count_if(bonds[atom].begin(), bonds[atom].end(), [&](std::uint32_t i) {
            const std::uint32_t other = other_end(graph.bonds[i], atom);
            return graph.atoms[other].element == "O" && bonds[other].size() == 1;
        }));
}

// What single bonds to all neighbours leave open.
int open_valence(const MoleculeGraph& graph, const BondLists& bonds, std::uint32_t atom) {
    const std::string& element = graph.atoms[atom].element;
    const int degree = static_cast<int>(bonds[atom].size());
    if (element == "N") {
        if (degree == 4) return 0;
        if (degree == 3) return terminal_oxygens(graph, bonds, atom) > 0 ? 1 : 0;
    }
    if (element == "O" && degree == 3) return 0;
    if ((element == "S" || element == "SE") && degree == 4) return 2;  // sulphonyl
    const int valence = usual_valence(element, degree);
    return std::max(0, valence - degree);
}

// Azides and diazo groups: N of two neighbours between two others, N=N=N in this count.
bool is_middle_of_azide(const MoleculeGraph& graph, const BondLists& bonds, std::uint32_t atom) {
    if (graph.atoms[atom].element != "N" || bonds[atom].size() != 2) return false;
    const auto at = [&](std::size_t i) { return other_end(graph.bonds[bonds[atom][i]], atom); };
    const auto is_end = [&](std::uint32_t other) {
        return graph.atoms[other].element == "N" && bonds[other].size() == 1;
    };
    return is_end(at(0)) || is_end(at(1));
}

// A carbon that is left open looks for a nitrogen that can be a cation: beside it in a ring, where
// that keeps the ring aromatic, then elsewhere. Returns whether all found one.
bool find_cations(const MoleculeGraph& graph, const BondLists& bonds, const std::vector<int>& open,
                  Pairing& pairing) {
    std::vector<bool> in_ring(graph.size());
    for (const auto& ring : find_rings(graph)) {
        for (const std::uint32_t atom : ring) in_ring[atom] = true;
    }
    bool all = true;
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        if (graph.atoms[i].element != "C" || pairing.open(i) == 0) continue;
        std::vector<std::pair<int, std::uint32_t>> candidates;
        for (std::uint32_t n = 0; n < graph.size(); ++n) {
            if (graph.atoms[n].element != "N" || bonds[n].size() != 3 || open[n] != 0) continue;
            const bool is_beside = std::any_of(
                bonds[i].begin(), bonds[i].end(),
                [&](std::uint32_t bond) { return other_end(graph.bonds[bond], i) == n; });
            candidates.emplace_back((is_beside ? 0 : 1) + (in_ring[n] ? 0 : 2), n);
        }
        std::sort(candidates.begin(), candidates.end());
        for (const auto& [rank, n] : candidates) {
            if (pairing.open(i) == 0) break;
            pairing.set_open(n, 1);
            pairing.satisfy(i);
            pairing.set_open(n, 0);
        }
        all = all && pairing.open(i) == 0;
    }
    return all;
}

// `cation`: a nitrogen of three neighbours that has a fourth bond from the start.
bool assign_with(MoleculeGraph& graph, std::optional<std::uint32_t> cation) {
    const BondLists bonds = bonds_of_atoms(graph);
    std::vector<int> open(graph.size());
    for (GraphBond& bond : graph.bonds) bond.order = 1;
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        open[i] = is_middle_of_azide(graph, bonds, i) ? 2 : open_valence(graph, bonds, i);
    }
    if (cation) open[*cation] = 1;
    Pairing pairing(graph, open, std::vector<bool>(graph.bonds.size(), true));
    for (const char* const element : {"C", "SI", "P", "SE", "S", "N", "O"}) {
        for (std::uint32_t i = 0; i < graph.size(); ++i) {
            if (graph.atoms[i].element == element) pairing.satisfy(i);
        }
    }
    const bool all = find_cations(graph, bonds, open, pairing);
    charge_by_valence(graph);
    return all;
}

bool has_cation_of_ring(const MoleculeGraph& graph) {
    const BondLists bonds = bonds_of_atoms(graph);
    for (const auto& ring : find_rings(graph)) {
        for (const std::uint32_t atom : ring) {
            for (const std::uint32_t bond : bonds[atom]) {
                const std::uint32_t other = other_end(graph.bonds[bond], atom);
                if (graph.bonds[bond].order != 2) continue;
                for (const std::uint32_t end : {atom, other}) {
                    if (graph.atoms[end].element == "N" && graph.atoms[end].charge > 0) return true;
                }
            }
        }
    }
    return false;
}

std::size_t count_aromatic(const MoleculeGraph& graph) {
    const Perceived seen = perceive(graph);
    return static_cast<std::size_t>(
        std::count(seen.ring_is_aromatic.begin(), seen.ring_is_aromatic.end(), true));
}

}  // namespace

int usual_valence(std::string_view element, int bonds) noexcept {
    struct Usual {
        std::string_view element;
        std::array<int, 3> valences;
    };
    static constexpr auto table = std::to_array<Usual>({{"H", {1, 1, 1}},
                                                        {"D", {1, 1, 1}},
                                                        {"B", {3, 3, 3}},
                                                        {"C", {4, 4, 4}},
                                                        {"SI", {4, 4, 4}},
                                                        {"N", {3, 3, 3}},
                                                        {"P", {3, 5, 5}},
                                                        {"O", {2, 2, 2}},
                                                        {"S", {2, 4, 6}},
                                                        {"SE", {2, 4, 6}},
                                                        {"F", {1, 1, 1}},
                                                        {"CL", {1, 1, 1}},
                                                        {"BR", {1, 1, 1}},
                                                        {"I", {1, 1, 1}}});
    for (const Usual& usual : table) {
        if (usual.element != element) continue;
        for (const int valence : usual.valences) {
            if (valence >= bonds) return valence;
        }
        return usual.valences.back();
    }
    return 0;
}

bool assign_bond_orders(MoleculeGraph& graph) {
    const bool all = assign_with(graph, std::nullopt);
    if (!all || !has_cation_of_ring(graph)) return all;
    // Of several nitrogens that may be the cation, the one that leaves most rings aromatic.
    std::size_t most = count_aromatic(graph);
    const MoleculeGraph first = graph;
    const BondLists bonds = bonds_of_atoms(graph);
    for (std::uint32_t n = 0; n < graph.size(); ++n) {
        if (graph.atoms[n].element != "N" || bonds[n].size() != 3) continue;
        MoleculeGraph other = first;
        if (!assign_with(other, n) || total_charge(other) != total_charge(first)) continue;
        const std::size_t aromatic = count_aromatic(other);
        if (aromatic <= most) continue;
        most = aromatic;
        graph = std::move(other);
    }
    return all;
}

bool pair_marked_bonds(MoleculeGraph& graph, const std::vector<bool>& marked,
                       const std::vector<int>& open) {
    Pairing pairing(graph, open, marked);
    bool all = true;
    for (const char* const element : {"C", "P", "SE", "S", "N", "O"}) {
        for (std::uint32_t i = 0; i < graph.size(); ++i) {
            if (graph.atoms[i].element != element) continue;
            pairing.satisfy(i);
            if (graph.atoms[i].element == "C") all = all && pairing.open(i) == 0;
        }
    }
    return all;
}

void charge_by_valence(MoleculeGraph& graph) {
    const BondLists bonds = bonds_of_atoms(graph);
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        GraphAtom& atom = graph.atoms[i];
        int sum = 0;
        for (const std::uint32_t bond : bonds[i]) sum += graph.bonds[bond].order;
        atom.charge = 0;
        if (atom.element == "N" || atom.element == "O") {
            atom.charge = sum - usual_valence(atom.element, 0);
        } else if (atom.element == "B" && sum == 4) {
            atom.charge = -1;
        } else if (atom.element == "S" && sum % 2 == 1) {
            atom.charge = sum == 1 ? -1 : 1;
        } else if (atom.element == "P" && sum == 4) {
            atom.charge = 1;
        } else if (atom.element == "C" && sum == 3) {
            atom.charge = -1;
        } else if (bonds[i].empty()) {
            atom.charge = atom.element == "F" || atom.element == "CL" || atom.element == "BR" ||
                                  atom.element == "I"
                              ? -1
                              : 0;
        }
    }
}

}  // namespace palpa
