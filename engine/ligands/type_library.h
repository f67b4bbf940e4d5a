// Chooses the CGenFF type of an atom: that of the atoms with the most similar surroundings in the
// force field's residues.
#pragma once
#include "ligands/environments.h"
#include "ligands/model_compounds.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

struct TypeChoice {
    std::string type;
    Surroundings level = Surroundings::Element;  // level at which the surroundings were equal
    double share = 1;           // share of such atoms in the force field with this type
    std::string example;        // a residue with such an atom
    double penalty = 0;         // larger for a lower level and share
    bool has_improper = false;  // most such atoms are the first of an improper
};

class TypeLibrary {
public:
    explicit TypeLibrary(std::span<const ModelCompound> compounds);

    // Unset for an element that no residue has.
    std::optional<TypeChoice> find(const EnvironmentKeys& keys) const;

private:
    struct Entry {
        std::map<std::string, std::uint32_t> types;   // number of atoms with each type
        std::map<std::string, std::string> examples;  // first residue with each type
        std::uint32_t atoms = 0, impropers = 0;
    };
    std::array<std::map<std::uint64_t, Entry>, surroundings_levels> entries_;
};

// What a type that is found at this level is worth less: 0 for surroundings that are equal to three
// bonds away, 100 where only the element is. Shares of wrong types by level are in
// tools/ligands.md.
double level_penalty(Surroundings level) noexcept;

}  // namespace palpa
