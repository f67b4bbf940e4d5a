#include "charmm/residue_checks.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

// By its letter: "1HB" and "HB1" are hydrogens.
char first_letter(std::string_view name) {
    const auto letter = std::find_if(name.begin(), name.end(), [](char c) {
        return std::isalpha(static_cast<unsigned char>(c)) != 0;
    });
    return letter == name.end() ? '\0' : *letter;
}

void check_atoms(const ForceField& force_field, const Structure& structure,
                 const ResidueInstance& instance, bool may_lack, Missing& missing) {
    std::vector<std::string_view> lacking;
    for (const auto& [name, numbers] : instance.wanted) {
        if (may_lack || instance.present.contains(name)) {
            find_type(force_field, numbers->type, numbers->place, missing);
        } else {
            lacking.push_back(name);
        }
    }
    for (const auto& [name, atom] : instance.present) {
        if (instance.wanted.contains(name)) continue;
        missing.add({structure.file, structure.lines[atom], 0},
                    fmt::format("residue {} has no atom '{}'", instance.label(), name));
        const char letter = first_letter(name);
        const bool may_be_other =
            std::any_of(lacking.begin(), lacking.end(),
                        [letter](std::string_view other) { return first_letter(other) == letter; });
        if (may_be_other) missing.advise(rename_advice);
    }
    if (lacking.empty()) return;
    missing.add(instance.place,
                fmt::format("residue {} lacks atom{} '{}'", instance.label(),
                            lacking.size() > 1 ? "s" : "", fmt::join(lacking, "', '")));
    missing.advise(add_advice);
}

// What a template's terms name and neither it nor a patch has, once for each template.
void check_names(const ResidueInstances& residues, const TemplateUse& use, Missing& missing) {
    for (const auto& [name, line] : use.residue->named_on) {
        const AtomReference reference = find_reference(residues, use, name);
        if (reference.is_neighbour || reference.residue == ResidueInstance::none) continue;
        const ResidueInstance& instance = residues.instances[reference.residue];
        if (!instance.is_settled || instance.wanted.contains(reference.atom) ||
            instance.deleted.contains(reference.atom)) {
            continue;
        }
        const TextPlace place{use.residue->place.file, line, 0};
        if (use.patch.empty()) {
            missing.add(place, fmt::format("atom '{}' in a term of residue '{}', which has no such "
                                           "ATOM line{}",
                                           name, instance.name.residue,
                                           near_name_hint(name, keys(instance.wanted))));
        } else {
            missing.add(
                place,
                fmt::format("atom '{}' in a term of patch '{}' does not exist in residue '{}'",
                            name, use.patch, instance.name.residue));
        }
    }
}

// What would be right in place of a bond that is too long.
std::string_view find_remedy(const ResidueInstances& residues, const TemplateUse& use,
                             const std::array<std::string, 2>& names) {
    const AtomReference a = find_reference(residues, use, names[0]);
    const AtomReference b = find_reference(residues, use, names[1]);
    if (a.is_neighbour || b.is_neighbour) {
        return "split the chain into two segments at a gap, or put a TER line there";
    }
    return a.residue == b.residue ? "check the coordinates of this residue"
                                  : "apply a patch only to residues in contact";
}

void check_bonds(const Structure& structure, const ResidueInstances& residues,
                 const TemplateUse& use, Missing& missing) {
    for (const auto& names : use.residue->bonds) {
        const auto bond = find_atoms(residues, use, names);
        if (!bond) continue;
        const auto [a, b] = *bond;
        const double length = (structure.positions[a] - structure.positions[b]).norm();
        if (!(length > longest_bond)) continue;  // one without a position has none
        missing.add(
            {structure.file, structure.lines[a], 0},
            fmt::format("a bond of {:.1f} Å from {} to {} of line {}; expected at most {} "
                        "Å: {}",
                        length, to_string(structure.names[a]), to_string(structure.names[b]),
                        structure.lines[b], longest_bond, find_remedy(residues, use, names)));
    }
}

}  // namespace

void check_residues(const ForceField& force_field, const Structure& structure,
                    const ResidueInstances& residues, bool may_lack, Missing& missing) {
    for (const ResidueInstance& instance : residues.instances) {
        if (instance.is_settled) check_atoms(force_field, structure, instance, may_lack, missing);
    }
    for (const TemplateUse& use : residues.uses) {
        check_names(residues, use, missing);
        check_bonds(structure, residues, use, missing);
    }
}

}  // namespace palpa
