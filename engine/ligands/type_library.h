// Which type of CGenFF an atom gets: that of the atoms with the most alike surroundings in the
// force field's own residues.
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
    Surroundings level = Surroundings::Element;  // at which surroundings were equal
    double share = 1;                            // of such atoms in the force field that have it
    std::string example;                         // a residue with such an atom
    double penalty = 0;                          // rises as the level falls and the share does
    bool has_improper = false;                   // most of such atoms are the first of an improper
};

class TypeLibrary {
public:
    explicit TypeLibrary(std::span<const ModelCompound> compounds);

    // None for an element that no residue has.
    std::optional<TypeChoice> find(const EnvironmentKeys& keys) const;

private:
    struct Entry {
        std::map<std::string, std::uint32_t> types;   // how many atoms have it
        std::map<std::string, std::string> examples;  // the first residue with it
        std::uint32_t atoms = 0, impropers = 0;
    };
    std::array<std::map<std::uint64_t, Entry>, surroundings_levels> entries_;
};

// What a type that is found at this level is worth less: 0 for surroundings that are equal to three
// bonds away, 100 where only the element is. Shares of wrong types by level are in
// tools/ligands.md.
double level_penalty(Surroundings level) noexcept;

}  // namespace palpa
