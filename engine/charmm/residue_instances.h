// The residues of a structure with what templates and patches make of them, for whatever is found
// by the names that residues use.
#pragma once
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "charmm/missing.h"
#include "molecule/atoms.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct ResidueInstance {
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    AtomName name;  // `atom` unused
    TextPlace place;
    const Residue* residue = nullptr;                               // null: unknown, and noted
    std::size_t previous = none, next = none;                       // in its chain
    std::map<std::string, std::uint32_t, std::less<>> present;      // atoms of the structure
    std::map<std::string, const ResidueAtom*, std::less<>> wanted;  // atoms it should have
    std::set<std::string, std::less<>> deleted;                     // by patches
    std::vector<std::string> patches;
    bool has_generated_terms = true;
    bool is_settled = true;  // false: what it should have is not known for sure, for a noted reason

    std::string label() const;  // "PROA CYS 3 with DISU"
};

// A template and the residues that it is used on: one, or those that a patch is given.
struct TemplateUse {
    const Residue* residue;
    std::vector<std::size_t> instances;
    std::string patch;  // its name; empty: a residue's own template
};

struct ResidueInstances {
    std::vector<ResidueInstance> instances;  // in the order of their first atoms
    std::vector<TemplateUse> uses;           // residues in that order, then patches
};

// By the rules of charmm/generate.h; what is wrong with residues and patches is noted.
ResidueInstances build_residue_instances(const ForceField& force_field, const Structure& structure,
                                         const GenerateSettings& settings, Missing& missing);

// An atom as a template names it: whose it is, and its own name.
struct AtomReference {
    std::size_t residue = ResidueInstance::none;
    std::string_view atom;
    bool is_neighbour = false;  // '+' or '-'
};

AtomReference find_reference(const ResidueInstances& residues, const TemplateUse& use,
                             std::string_view name);

// The atom that a template means by a name; nothing if the structure does not have it, or the chain
// does not go on with it.
std::optional<std::uint32_t> find_atom(const ResidueInstances& residues, const TemplateUse& use,
                                       std::string_view name);

// The same of several atoms; nothing if one is not there.
template <std::size_t Size>
std::optional<std::array<std::uint32_t, Size>> find_atoms(
    const ResidueInstances& residues, const TemplateUse& use,
    const std::array<std::string, Size>& names) {
    std::array<std::uint32_t, Size> atoms{};
    for (std::size_t i = 0; i < Size; ++i) {
        const std::optional<std::uint32_t> atom = find_atom(residues, use, names[i]);
        if (!atom) return std::nullopt;
        atoms[i] = *atom;
    }
    return atoms;
}

}  // namespace palpa
