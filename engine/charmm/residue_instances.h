// The residues of a structure with their templates and patches applied, to find atoms by the names
// that templates use.
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
    const Residue* residue = nullptr;                           // null: unknown, which was noted
    std::size_t previous = none, next = none;                   // neighbours in the chain
    std::map<std::string, std::uint32_t, std::less<>> present;  // atoms in the structure
    std::map<std::string, const ResidueAtom*, std::less<>>
        wanted;                                  // atoms of the template and patches
    std::set<std::string, std::less<>> deleted;  // atoms that patches delete
    std::vector<std::string> patches;
    bool has_generated_terms = true;
    bool is_settled = true;  // false: the wanted atoms are uncertain, for a noted reason

    std::string label() const;  // "PROA CYS 3 with DISU"
};

// A template or patch and the residues to which it applies.
struct TemplateUse {
    const Residue* residue;
    std::vector<std::size_t> instances;
    std::string patch;  // name of the patch; empty: a residue's own template
};

struct ResidueInstances {
    std::vector<ResidueInstance> instances;  // in the order of their first atoms
    std::vector<TemplateUse> uses;           // residues in this order, then patches
};

// By the rules of charmm/generate.h; what is wrong with residues and patches is noted.
ResidueInstances build_residue_instances(const ForceField& force_field, const Structure& structure,
                                         const GenerateSettings& settings, Missing& missing);

// An atom name of a template: its residue and its name there.
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
