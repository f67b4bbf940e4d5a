#include "ligands/analogy.h"

#include "charmm/find_parameters.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace palpa {
namespace {

// How much the distance of the type in each place counts.
constexpr std::array bond_weights{1.0, 1.0};
constexpr std::array angle_weights{0.6, 1.4, 0.6};
constexpr std::array dihedral_weights{0.3, 1.2, 1.2, 0.3};
constexpr std::array improper_weights{1.2, 0.5, 0.5, 0.5};
constexpr double wildcard = 6;  // the distance of any type to X

// Inner atoms first, which differ most. What is no better than `least` is not summed up.
template <std::size_t Size>
double distance(const TypeDistances& distances, const Types<Size>& wanted, const Types<Size>& known,
                const std::array<double, Size>& weights, double least) {
    double sum = 0;
    for (std::size_t i = 0; i < Size && sum < least; ++i) {
        const std::size_t at = (i + 1) % Size;
        sum +=
            weights[at] * (known[at] == "X" ? wildcard : distances.between(wanted[at], known[at]));
    }
    return sum;
}

template <std::size_t Size>
struct Nearest {
    Types<Size> types;
    double penalty;
};

template <std::size_t Size>
Types<Size> types_of_key(const std::array<std::string, Size>& key) {
    return key;
}

Types<2> types_of_key(const std::pair<std::string, std::string>& key) {
    return {key.first, key.second};
}

// The entry of the least distance, the first of several. `is_symmetric`: it may be read either way.
template <std::size_t Size, class Map>
std::optional<Nearest<Size>> find_nearest(const Map& map, const Types<Size>& wanted,
                                          const TypeDistances& distances,
                                          const std::array<double, Size>& weights) {
    std::optional<Nearest<Size>> best;
    for (const auto& entry : map) {
        Types<Size> known = types_of_key(entry.first);
        for (int way = 0; way < 2; ++way) {
            const double least = best ? best->penalty : TypeDistances::unlike;
            const double penalty = distance(distances, wanted, known, weights, least);
            if (penalty < least) best = Nearest<Size>{known, penalty};
            std::reverse(known.begin(), known.end());
        }
    }
    return best;
}

template <std::size_t Size>
auto key_of(const Types<Size>& types) {
    if constexpr (Size == 2) {
        return in_order(types[0], types[1]);
    } else {
        return in_order(types);
    }
}

class Completer {
public:
    Completer(const std::vector<std::string>& types, const TypeDistances& distances,
              ForceField& into)
        : types_(types), distances_(distances), into_(into) {}

    // What `find` does not find gets the numbers of the nearest entry of the map.
    template <std::size_t Size, class Map, class Find>
    void complete(TermKind kind, const std::vector<std::vector<std::uint32_t>>& terms, Map& map,
                  const std::array<double, Size>& weights, const Find& find) {
        // Analogies of analogies would drift.
        const Map known = map;
        for (const std::vector<std::uint32_t>& atoms : terms) {
            Types<Size> wanted;
            for (std::size_t i = 0; i < Size; ++i) wanted[i] = types_[atoms[i]];
            if (find(into_, wanted)) continue;
            const auto nearest = find_nearest<Size>(known, wanted, distances_, weights);
            if (!nearest) continue;
            map[key_of<Size>(wanted)] = known.at(key_of<Size>(nearest->types));
            made_.push_back({kind,
                             {wanted.begin(), wanted.end()},
                             {nearest->types.begin(), nearest->types.end()},
                             atoms,
                             nearest->penalty});
        }
    }

    std::vector<Analogy> take() { return std::move(made_); }

private:
    const std::vector<std::string>& types_;
    const TypeDistances& distances_;
    ForceField& into_;
    std::vector<Analogy> made_;
};

}  // namespace

ResidueTerms find_terms(const MoleculeGraph& graph,
                        std::span<const std::array<std::uint32_t, 4>> impropers) {
    ResidueTerms terms;
    std::vector<std::vector<std::uint32_t>> near(graph.size());
    for (const GraphBond& bond : graph.bonds) {
        near[bond.a].push_back(bond.b);
        near[bond.b].push_back(bond.a);
        terms.bonds.push_back({bond.a, bond.b});
    }
    for (std::uint32_t centre = 0; centre < graph.size(); ++centre) {
        for (std::size_t i = 0; i < near[centre].size(); ++i) {
            for (std::size_t j = i + 1; j < near[centre].size(); ++j) {
                terms.angles.push_back({near[centre][i], centre, near[centre][j]});
            }
        }
    }
    for (const GraphBond& bond : graph.bonds) {
        for (const std::uint32_t a : near[bond.a]) {
            for (const std::uint32_t d : near[bond.b]) {
                if (a == bond.b || d == bond.a || a == d) continue;
                terms.dihedrals.push_back({a, bond.a, bond.b, d});
            }
        }
    }
    for (const auto& improper : impropers) {
        terms.impropers.emplace_back(improper.begin(), improper.end());
    }
    return terms;
}

std::vector<Analogy> add_missing_parameters(const ResidueTerms& terms,
                                            const std::vector<std::string>& types,
                                            const TypeDistances& distances, ForceField& into) {
    Completer completer(types, distances, into);
    completer.complete(TermKind::Bond, terms.bonds, into.bonds, bond_weights, find_bond);
    completer.complete(TermKind::Angle, terms.angles, into.angles, angle_weights, find_angle);
    completer.complete(TermKind::Dihedral, terms.dihedrals, into.dihedrals, dihedral_weights,
                       find_dihedral);
    completer.complete(TermKind::Improper, terms.impropers, into.impropers, improper_weights,
                       find_improper);
    return completer.take();
}

const char* name_of(TermKind kind) noexcept {
    constexpr std::array names{"bond", "angle", "dihedral", "improper"};
    return names[static_cast<std::size_t>(kind)];
}

}  // namespace palpa
