#include "ligands/match.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>

namespace palpa {
namespace {

using Match = std::vector<std::uint32_t>;
constexpr std::uint32_t none = ~std::uint32_t{0};

std::optional<Match> match_by_names(const MoleculeGraph& known, const MoleculeGraph& found) {
    std::map<std::string, std::uint32_t> index;
    for (std::uint32_t i = 0; i < known.size(); ++i) index.emplace(known.atoms[i].name, i);
    Match match;
    for (const GraphAtom& atom : found.atoms) {
        if (atom.element == "H") continue;
        const auto at = index.find(atom.name);
        if (at == index.end() || known.atoms[at->second].element != atom.element) {
            return std::nullopt;
        }
        match.push_back(at->second);
    }
    return match;
}

// Backtracking over the atoms of `found`, each (but the first of a piece) beside one before it.
class Matcher {
public:
    Matcher(const MoleculeGraph& known, const MoleculeGraph& found)
        : known_(known),
          found_(found),
          near_known_(heavy_neighbours(known)),
          near_found_(heavy_neighbours(found)),
          of_found_(found.size(), none),
          is_taken_(known.size(), false) {
        std::vector<bool> listed(found.size());
        for (std::uint32_t i = 0; i < found.size(); ++i) list_from(i, listed);
    }

    std::optional<Match> match() {
        if (!extend(0)) return std::nullopt;
        Match result;
        for (std::uint32_t i = 0; i < found_.size(); ++i) {
            if (!found_.is_hydrogen(i)) result.push_back(of_found_[i]);
        }
        return result;
    }

private:
    static std::vector<Match> heavy_neighbours(const MoleculeGraph& graph) {
        std::vector<Match> near(graph.size());
        for (const GraphBond& bond : graph.bonds) {
            if (graph.is_hydrogen(bond.a) || graph.is_hydrogen(bond.b)) continue;
            near[bond.a].push_back(bond.b);
            near[bond.b].push_back(bond.a);
        }
        return near;
    }

    void list_from(std::uint32_t first, std::vector<bool>& listed) {
        if (listed[first] || found_.is_hydrogen(first)) return;
        listed[first] = true;
        order_.push_back(first);
        for (std::size_t at = order_.size() - 1; at < order_.size(); ++at) {
            for (const std::uint32_t next : near_found_[order_[at]]) {
                if (listed[next]) continue;
                listed[next] = true;
                order_.push_back(next);
            }
        }
    }

    bool fits(std::uint32_t atom, std::uint32_t to) const {
        if (is_taken_[to] || known_.atoms[to].element != found_.atoms[atom].element ||
            near_known_[to].size() < near_found_[atom].size()) {
            return false;
        }
        return std::all_of(
            near_found_[atom].begin(), near_found_[atom].end(), [&](std::uint32_t next) {
                const auto& near = near_known_[to];
                return of_found_[next] == none ||
                       std::find(near.begin(), near.end(), of_found_[next]) != near.end();
            });
    }

    bool extend(std::size_t at) {
        if (at == order_.size()) return true;
        if (++steps_ > most_steps) return false;
        const std::uint32_t atom = order_[at];
        for (std::uint32_t to = 0; to < known_.size(); ++to) {
            if (known_.is_hydrogen(to) || !fits(atom, to)) continue;
            of_found_[atom] = to;
            is_taken_[to] = true;
            if (extend(at + 1)) return true;
            of_found_[atom] = none;
            is_taken_[to] = false;
        }
        return false;
    }

    static constexpr int most_steps = 200'000;
    const MoleculeGraph& known_;
    const MoleculeGraph& found_;
    std::vector<Match> near_known_, near_found_;
    Match of_found_, order_;
    std::vector<bool> is_taken_;
    int steps_ = 0;
};

}  // namespace

std::optional<Match> match_atoms(const MoleculeGraph& known, const MoleculeGraph& found) {
    if (auto match = match_by_names(known, found)) return match;
    return Matcher(known, found).match();
}

}  // namespace palpa
