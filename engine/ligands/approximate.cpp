#include "ligands/approximate.h"

#include "charmm/find_parameters.h"
#include "core/load_error.h"
#include "ligands/environments.h"
#include "ligands/perception.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace palpa {
namespace {

std::vector<TypeChoice> choose_types(const MoleculeGraph& graph, const TypeLibrary& library,
                                     const std::vector<EnvironmentKeys>& keys) {
    std::vector<TypeChoice> types;
    for (std::size_t i = 0; i < graph.size(); ++i) {
        auto choice = library.find(keys[i]);
        if (!choice) {
            throw LoadError({graph.name},
                            fmt::format("CGenFF has no type for {} ({}); expected H, C, N, O, P, S "
                                        "and halogens",
                                        graph.atoms[i].name, graph.atoms[i].element));
        }
        types.push_back(std::move(*choice));
    }
    return types;
}

// The order of an improper's outer atoms is what the parameters have; where they have none of the
// first kind there is no improper.
std::vector<std::array<std::uint32_t, 4>> find_impropers(const MoleculeGraph& graph,
                                                         const Perceived& seen,
                                                         const std::vector<TypeChoice>& types,
                                                         const ForceField& force_field) {
    std::vector<std::array<std::uint32_t, 4>> impropers;
    for (std::uint32_t centre = 0; centre < graph.size(); ++centre) {
        if (!types[centre].has_improper || seen.bonds[centre].size() != 3) continue;
        std::array<std::uint32_t, 3> around{};
        for (std::size_t i = 0; i < 3; ++i) {
            around[i] = other_end(graph.bonds[seen.bonds[centre][i]], centre);
        }
        std::sort(around.begin(), around.end());
        do {
            const Types<4> wanted{types[centre].type, types[around[0]].type, types[around[1]].type,
                                  types[around[2]].type};
            if (!find_improper(force_field, wanted)) continue;
            impropers.push_back({centre, around[0], around[1], around[2]});
            break;
        } while (std::next_permutation(around.begin(), around.end()));
    }
    return impropers;
}

Residue build_residue(const ApproximateLigand& ligand,
                      const std::vector<std::array<std::uint32_t, 4>>& impropers) {
    Residue residue;
    residue.charge = total_charge(ligand.graph);
    residue.first_patch = residue.last_patch = "NONE";
    residue.place.file = "--approximate-ligands";
    const auto name = [&](std::uint32_t atom) { return ligand.graph.atoms[atom].name; };
    for (std::uint32_t i = 0; i < ligand.graph.size(); ++i) {
        residue.atoms.push_back(
            {name(i), ligand.types[i].type, ligand.charges[i], 0, residue.place});
        residue.named_on.emplace(name(i), 0);
    }
    for (const GraphBond& bond : ligand.graph.bonds) {
        residue.bonds.push_back({name(bond.a), name(bond.b)});
    }
    for (const auto& atoms : impropers) {
        residue.impropers.push_back(
            {name(atoms[0]), name(atoms[1]), name(atoms[2]), name(atoms[3])});
    }
    return residue;
}

// Bonds outside of rings with something to turn at both ends.
std::vector<std::array<std::uint32_t, 2>> find_doubtful_turns(const ApproximateLigand& ligand,
                                                              const Perceived& seen) {
    std::vector<std::array<std::uint32_t, 2>> doubtful;
    for (const Analogy& analogy : ligand.analogies) {
        if (analogy.kind != TermKind::Dihedral || analogy.penalty < high_penalty) continue;
        const std::array<std::uint32_t, 2> bond{std::min(analogy.atoms[1], analogy.atoms[2]),
                                                std::max(analogy.atoms[1], analogy.atoms[2])};
        for (const std::uint32_t i : seen.bonds[bond[0]]) {
            if (other_end(ligand.graph.bonds[i], bond[0]) != bond[1] || seen.bond_in_ring[i]) {
                continue;
            }
            if (std::find(doubtful.begin(), doubtful.end(), bond) == doubtful.end()) {
                doubtful.push_back(bond);
            }
        }
    }
    return doubtful;
}

}  // namespace

LigandModel build_ligand_model(const ForceField& force_field,
                               const std::vector<std::string>& withheld) {
    std::vector<ModelCompound> compounds = find_model_compounds(force_field, withheld);
    constexpr std::size_t few = 100;
    if (compounds.size() < few) {
        throw LoadError(
            {"--approximate-ligands"},
            fmt::format("the force field has only {} model compounds of CGenFF; expected "
                        "top_all36_cgenff.rtf and par_all36_cgenff.prm among its files",
                        compounds.size()));
    }
    TypeLibrary types(compounds);
    ChargeModel charges(compounds);
    TypeDistances distances(compounds);
    return {std::move(compounds), std::move(types), std::move(charges), std::move(distances)};
}

ApproximateLigand approximate_ligand(const MoleculeGraph& graph, const LigandModel& model,
                                     ForceField& into) {
    ApproximateLigand ligand;
    ligand.name = graph.name;
    ligand.graph = graph;
    const Perceived seen = perceive(graph);
    const std::vector<EnvironmentKeys> keys = find_environments(graph, seen);
    ligand.types = choose_types(graph, model.types, keys);
    std::vector<std::string> types;
    for (const TypeChoice& choice : ligand.types) types.push_back(choice.type);
    ligand.charges = model.charges.charges_of(graph, seen, keys, types);
    const auto impropers = find_impropers(graph, seen, ligand.types, into);
    ligand.analogies =
        add_missing_parameters(find_terms(graph, impropers), types, model.distances, into);
    ligand.doubtful_turns = find_doubtful_turns(ligand, seen);
    ligand.residue = build_residue(ligand, impropers);
    if (!into.residues.emplace(graph.name, ligand.residue).second) {
        throw LoadError({graph.name}, "the force field already has a residue of this name");
    }
    return ligand;
}

}  // namespace palpa
