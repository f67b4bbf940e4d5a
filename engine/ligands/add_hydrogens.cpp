#include "ligands/add_hydrogens.h"

#include "ligands/bond_orders.h"
#include "ligands/perception.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

namespace palpa {
namespace {

constexpr double ph = 7.4;

class Protonation {
public:
    Protonation(MoleculeGraph& graph, std::vector<std::string>& notes)
        : graph_(graph), notes_(notes), seen_(perceive(graph)) {}

    void decide() {
        for (std::uint32_t i = 0; i < graph_.size(); ++i) give_proton_away(i);
        for (std::uint32_t i = 0; i < graph_.size(); ++i) charge_amidine(i);
        charge_amines();
    }

private:
    const std::string& element(std::uint32_t atom) const { return graph_.atoms[atom].element; }

    std::vector<std::uint32_t> heavy_around(std::uint32_t atom) const {
        std::vector<std::uint32_t> around;
        for (const std::uint32_t i : seen_.bonds[atom]) {
            const std::uint32_t other = other_end(graph_.bonds[i], atom);
            if (!graph_.is_hydrogen(other)) around.push_back(other);
        }
        return around;
    }

    bool is_saturated(std::uint32_t atom) const {
        return !seen_.is_aromatic[atom] &&
               std::all_of(seen_.bonds[atom].begin(), seen_.bonds[atom].end(),
                           [&](std::uint32_t i) { return graph_.bonds[i].order == 1; });
    }

    bool has_double_to(std::uint32_t atom, const char* other) const {
        return std::any_of(seen_.bonds[atom].begin(), seen_.bonds[atom].end(),
                           [&](std::uint32_t i) {
                               return graph_.bonds[i].order == 2 &&
                                      element(other_end(graph_.bonds[i], atom)) == other;
                           });
    }

    void note(std::uint32_t atom, const std::string& what) {
        notes_.push_back(fmt::format("{} {}",
                                     graph_.atoms[atom].name.empty()
                                         ? element(atom) + std::to_string(atom + 1)
                                         : graph_.atoms[atom].name,
                                     what));
    }

    void give_proton_away(std::uint32_t atom) {
        if (element(atom) != "O" || graph_.atoms[atom].charge != 0 || !is_saturated(atom)) return;
        const auto around = heavy_around(atom);
        if (around.size() != 1) return;
        const std::uint32_t centre = around[0];
        const std::string& of = element(centre);
        if ((of != "C" && of != "P" && of != "S") || !has_double_to(centre, "O")) return;
        graph_.atoms[atom].charge = -1;
        note(atom, fmt::format("is the charged oxygen of {} acid", of == "C"   ? "a carboxylic"
                                                                   : of == "P" ? "a phosphoric"
                                                                               : "a sulphonic"));
    }

    void charge_amidine(std::uint32_t centre) {
        if (element(centre) != "C" || seen_.is_aromatic[centre]) return;
        std::uint32_t imine = centre;
        std::size_t nitrogens = 0;
        for (const std::uint32_t i : seen_.bonds[centre]) {
            const std::uint32_t other = other_end(graph_.bonds[i], centre);
            if (element(other) != "N") continue;
            ++nitrogens;
            if (graph_.bonds[i].order == 2) imine = other;
            if (seen_.is_aromatic[other] || graph_.atoms[other].charge != 0) return;
            for (const std::uint32_t next : heavy_around(other)) {
                if (next != centre && (element(next) != "C" || !is_saturated(next))) return;
            }
        }
        if (imine == centre || nitrogens < 2) return;
        graph_.atoms[imine].charge = 1;
        note(imine, nitrogens == 3 ? "makes its guanidine a cation" : "makes its amidine a cation");
    }

    bool is_amine(std::uint32_t atom) const {
        if (element(atom) != "N" || graph_.atoms[atom].charge != 0 || !is_saturated(atom)) {
            return false;
        }
        const auto around = heavy_around(atom);
        return !around.empty() && around.size() <= 3 &&
               std::all_of(around.begin(), around.end(), [&](std::uint32_t other) {
                   return element(other) == "C" && is_saturated(other);
               });
    }

    double effect_of_second(std::uint32_t atom) const {
        if (has_double_to(atom, "O")) return 2.5;
        return seen_.is_aromatic[atom] ? 1.2 : 0;
    }

    double effect_of_third(std::uint32_t atom) const {
        const std::string& of = element(atom);
        if (seen_.is_aromatic[atom]) return 0;
        if (of == "N") return graph_.atoms[atom].charge > 0 ? 4 : 1;
        if (of == "O" || of == "S") return graph_.atoms[atom].charge < 0 ? 0 : 1;
        if (of == "F") return 1.6;
        return of == "C" && has_double_to(atom, "O") ? 0.8 : 0;
    }

    double pka(std::uint32_t amine) const {
        const auto first = heavy_around(amine);
        double value = first.size() == 1 ? 10.6 : first.size() == 2 ? 11 : 10;
        std::set<std::uint32_t> met(first.begin(), first.end());
        met.insert(amine);
        std::vector<std::uint32_t> second;
        for (const std::uint32_t atom : first) {
            for (const std::uint32_t next : heavy_around(atom)) {
                if (!met.insert(next).second) continue;
                second.push_back(next);
                value -= effect_of_second(next);
            }
        }
        for (const std::uint32_t atom : second) {
            if (seen_.is_aromatic[atom] || has_double_to(atom, "O")) continue;
            for (const std::uint32_t next : heavy_around(atom)) {
                if (met.insert(next).second) value -= effect_of_third(next);
            }
        }
        return value;
    }

    void charge_amines() {
        while (true) {
            double highest = ph;
            std::uint32_t strongest = 0;
            for (std::uint32_t i = 0; i < graph_.size(); ++i) {
                if (!is_amine(i) || pka(i) <= highest) continue;
                highest = pka(i);
                strongest = i;
            }
            if (highest == ph) return;
            graph_.atoms[strongest].charge = 1;
            note(strongest, fmt::format("is a cation, its pKa is about {:.0f}", highest));
        }
    }

    MoleculeGraph& graph_;
    std::vector<std::string>& notes_;
    Perceived seen_;
};

int sum_of_orders(const MoleculeGraph& graph, const BondLists& bonds, std::uint32_t atom) {
    int sum = 0;
    for (const std::uint32_t i : bonds[atom]) {
        if (!graph.is_hydrogen(other_end(graph.bonds[i], atom))) sum += graph.bonds[i].order;
    }
    return sum;
}

// N(=O)=O becomes N+(=O)O-.
void charge_nitro_groups(MoleculeGraph& graph, const BondLists& bonds) {
    for (std::uint32_t n = 0; n < graph.size(); ++n) {
        if (graph.atoms[n].element != "N" || sum_of_orders(graph, bonds, n) < 4) continue;
        for (const std::uint32_t i : bonds[n]) {
            GraphAtom& end = graph.atoms[other_end(graph.bonds[i], n)];
            if (end.element != "O" || graph.bonds[i].order != 2) continue;
            if (sum_of_orders(graph, bonds, n) < 5) break;
            graph.bonds[i].order = 1;
            end.charge = -1;
        }
        graph.atoms[n].charge = 1;
    }
}

int hydrogens_on(const MoleculeGraph& graph, const BondLists& bonds, std::uint32_t atom) {
    const GraphAtom& a = graph.atoms[atom];
    const int sum = sum_of_orders(graph, bonds, atom);
    const bool loses = a.element == "C" || a.element == "B" || a.element == "SI";
    const int shift = loses ? -std::abs(a.charge) : a.charge;
    return std::max(0, usual_valence(a.element, sum - shift) + shift - sum);
}

}  // namespace

void charge_at_ph_7(MoleculeGraph& graph, std::vector<std::string>& notes) {
    Protonation(graph, notes).decide();
}

MoleculeGraph with_hydrogens(const MoleculeGraph& graph) {
    std::vector<bool> is_hydrogen(graph.size());
    std::vector<std::vector<GraphAtom>> had(graph.size());
    for (const GraphBond& bond : graph.bonds) {
        if (graph.is_hydrogen(bond.a)) had[bond.b].push_back(graph.atoms[bond.a]);
        if (graph.is_hydrogen(bond.b)) had[bond.a].push_back(graph.atoms[bond.b]);
    }
    std::set<std::string> names;
    std::vector<std::vector<GraphAtom>> had_by_heavy;
    for (std::size_t i = 0; i < graph.size(); ++i) {
        is_hydrogen[i] = graph.is_hydrogen(i);
        names.insert(graph.atoms[i].name);
        if (!is_hydrogen[i]) had_by_heavy.push_back(had[i]);
    }
    MoleculeGraph result = without_atoms(graph, is_hydrogen);
    charge_nitro_groups(result, bonds_of_atoms(result));
    const BondLists bonds = bonds_of_atoms(result);
    const auto heavy = static_cast<std::uint32_t>(result.size());
    std::size_t number = 0;
    for (std::uint32_t i = 0; i < heavy; ++i) {
        const int count = hydrogens_on(result, bonds, i);
        for (int h = 0; h < count; ++h) {
            GraphAtom hydrogen{"", "H", 0, std::nullopt};
            if (static_cast<std::size_t>(h) < had_by_heavy[i].size()) {
                hydrogen = had_by_heavy[i][static_cast<std::size_t>(h)];
            }
            while (hydrogen.name.empty()) {
                std::string name = fmt::format("H{}", ++number);
                if (names.insert(name).second) hydrogen.name = std::move(name);
            }
            result.bonds.push_back({i, static_cast<std::uint32_t>(result.size()), 1});
            result.atoms.push_back(std::move(hydrogen));
        }
    }
    return result;
}

}  // namespace palpa
