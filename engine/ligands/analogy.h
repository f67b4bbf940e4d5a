// Finds missing bonded parameters by analogy: it takes those of the most similar types.
#pragma once
#include "charmm/force_field.h"
#include "ligands/type_traits.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// The terms of a residue by atom index: those from its bonds, and impropers.
struct ResidueTerms {
    std::vector<std::vector<std::uint32_t>> bonds, angles, dihedrals, impropers;
};
ResidueTerms find_terms(const MoleculeGraph& graph,
                        std::span<const std::array<std::uint32_t, 4>> impropers);

enum class TermKind : std::uint8_t { Bond, Angle, Dihedral, Improper };

// One parameter found by analogy.
struct Analogy {
    TermKind kind = TermKind::Bond;
    std::vector<std::string> types;    // types that need it
    std::vector<std::string> from;     // types from which it was taken
    std::vector<std::uint32_t> atoms;  // the first term that needs it
    double penalty = 0;  // the weighted distance of the types; that of inner atoms counts most
};

// Above this penalty a dihedral says little about the barrier of its bond.
inline constexpr double high_penalty = 40;

// Adds what is missing for the terms. What has no likeness at all (penalty of TypeDistances::unlike
// or more) is left missing: charmm/build_topology.h names it.
std::vector<Analogy> add_missing_parameters(const ResidueTerms& terms,
                                            const std::vector<std::string>& types,
                                            const TypeDistances& distances, ForceField& into);

// "bond", "angle", "dihedral", "improper"
const char* name_of(TermKind kind) noexcept;

}  // namespace palpa
