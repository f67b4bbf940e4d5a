// Partial charges by bond charge increments that are fitted to the force field's own residues.
//
// An atom's charge is its formal charge, and for each bond what flows along it. The flow between
// types a and b is chi(b) - chi(a) + d(a, b): the d of pairs that residues have, chi for pairs that
// none has. chi and d are found by least squares over all atoms of all residues, d and chi being
// drawn towards 0. The remainder is averaged over atoms of equal surroundings, level by level,
// and added where an atom has such surroundings.
#pragma once
#include "ligands/environments.h"
#include "ligands/model_compounds.h"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

class ChargeModel {
public:
    explicit ChargeModel(std::span<const ModelCompound> compounds);

    // The charge of each atom, e. They add up to the sum of the formal charges, exactly to three
    // decimals.
    std::vector<double> charges_of(const MoleculeGraph& graph, const Perceived& seen,
                                   const std::vector<EnvironmentKeys>& keys,
                                   const std::vector<std::string>& types) const;

private:
    double flow(const std::string& to, const std::string& from) const;
    double by_bonds(const MoleculeGraph& graph, const Perceived& seen,
                    const std::vector<std::string>& types, std::uint32_t atom) const;
    void fit_increments(std::span<const ModelCompound> compounds);
    void fit_residuals(std::span<const ModelCompound> compounds);

    std::map<std::string, double> chi_;  // e
    std::map<std::pair<std::string, std::string>, double>
        extra_;  // e, from the second to the first
    std::array<std::map<std::uint64_t, double>, surroundings_levels> residuals_;  // e
};

}  // namespace palpa
