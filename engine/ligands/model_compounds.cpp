#include "ligands/model_compounds.h"

#include "ligands/bond_orders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace palpa {
namespace {

constexpr std::string_view lone_pair_element = "X";

// CGenFF's types say it before their "G"; not all of its MASS lines do.
constexpr auto type_elements =
    std::to_array<std::string_view>({"CL", "BR", "AL", "C", "H", "N", "O", "S", "P", "F", "I"});

bool is_lone_pair(const ForceField& force_field, const ResidueAtom& atom) {
    const auto type = force_field.types.find(atom.type);
    return atom.type.starts_with("LP") ||
           (type != force_field.types.end() && type->second.element == lone_pair_element);
}

// Where the charges of lone pairs go: to the one halogen that has a positive hole, in order.
void add_lone_pairs(const std::vector<double>& lone_pairs, ModelCompound& compound) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < compound.graph.size() && next < lone_pairs.size(); ++i) {
        const std::string& element = compound.graph.atoms[i].element;
        if (element != "CL" && element != "BR" && element != "I") continue;
        compound.charges[i] += lone_pairs[next++];
    }
}

}  // namespace

std::string_view element_of_cgenff_type(std::string_view type) noexcept {
    for (const std::string_view element : type_elements) {
        if (type.starts_with(element) && type.substr(element.size()).starts_with("G")) {
            return element;
        }
    }
    return {};
}

std::optional<ModelCompound> find_model_compound(const ForceField& force_field,
                                                 const std::string& name) {
    const Residue& residue = force_field.residues.at(name);
    ModelCompound compound;
    compound.name = compound.graph.name = name;
    std::map<std::string, std::uint32_t, std::less<>> index;
    std::vector<double> lone_pairs;
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    for (const ResidueAtom& atom : residue.atoms) {
        if (is_lone_pair(force_field, atom)) {
            lone_pairs.push_back(atom.charge);
            continue;
        }
        const std::string_view element = element_of_cgenff_type(atom.type);
        if (element.empty()) return std::nullopt;
        index.emplace(atom.name, static_cast<std::uint32_t>(compound.graph.size()));
        compound.graph.atoms.push_back({atom.name, std::string(element), 0, std::nullopt});
        compound.types.push_back(atom.type);
        compound.charges.push_back(atom.charge);
    }
    for (const auto& [a, b] : residue.bonds) {
        if (a.starts_with("LP") || b.starts_with("LP")) continue;
        const auto first = index.find(a), second = index.find(b);
        if (first == index.end() || second == index.end()) return std::nullopt;
        // Some are there twice, as BOND and as DOUBLE.
        const auto [low, high] = std::minmax(first->second, second->second);
        if (known.emplace(low, high).second) compound.graph.bonds.push_back({low, high, 1});
    }
    if (compound.graph.bonds.empty() || compound.graph.size() > most_ligand_atoms) {
        return std::nullopt;
    }
    add_lone_pairs(lone_pairs, compound);
    if (!assign_bond_orders(compound.graph) ||
        std::abs(total_charge(compound.graph) - residue.charge) > 0.01) {
        return std::nullopt;
    }
    compound.seen = perceive(compound.graph);
    compound.keys = find_environments(compound.graph, compound.seen);
    compound.has_improper.resize(compound.graph.size());
    for (const auto& improper : residue.impropers) {
        const auto centre = index.find(improper[0]);
        if (centre != index.end()) compound.has_improper[centre->second] = true;
    }
    return compound;
}

std::vector<ModelCompound> find_model_compounds(const ForceField& force_field,
                                                const std::vector<std::string>& withheld) {
    std::vector<ModelCompound> compounds;
    for (const auto& [name, residue] : force_field.residues) {
        if (std::find(withheld.begin(), withheld.end(), name) != withheld.end()) continue;
        if (auto compound = find_model_compound(force_field, name)) {
            compounds.push_back(std::move(*compound));
        }
    }
    return compounds;
}

}  // namespace palpa
