#include "prepare/wanted_atoms.h"

#include <cstdint>
#include <numbers>

namespace palpa {
namespace {

using std::numbers::pi;

// An atom's name without the digit that means this residue; none for one of another residue.
std::optional<std::string> own_name(const std::string& name, std::optional<std::size_t> place) {
    if (name.empty() || name[0] == '+' || name[0] == '-') return std::nullopt;
    if (!place || name.size() < 2 || name[0] < '1' || name[0] > '9') return name;
    if (static_cast<std::size_t>(name[0] - '1') != *place) return std::nullopt;
    return name.substr(1);
}

}  // namespace

BondedAtoms find_bonded_atoms(const WantedAtoms& wanted) {
    BondedAtoms atoms;
    std::map<std::string_view, std::uint32_t> indices;
    for (const auto& [name, element] : wanted.elements) {
        if (element == "H") continue;
        indices.emplace(name, static_cast<std::uint32_t>(atoms.names.size()));
        atoms.names.push_back(name);
        atoms.elements.push_back(element);
    }
    atoms.neighbours.resize(atoms.names.size());
    for (const auto& [a, b] : wanted.bonds) {
        const auto first = indices.find(a), second = indices.find(b);
        if (first != indices.end() && second != indices.end()) {
            atoms.add_bond(first->second, second->second);
        }
    }
    return atoms;
}

WantedAtomsFinder::WantedAtomsFinder(const ForceField& force_field,
                                     const GenerateSettings& settings)
    : force_field_(force_field) {
    for (const SegmentSettings& segment : settings.segments) {
        segments_[segment.segment] = &segment;
    }
    for (const PatchUse& use : settings.patches) {
        for (std::size_t i = 0; i < use.residues.size(); ++i) {
            const ResidueId& id = use.residues[i];
            uses_[{id.segment, id.number}].emplace_back(use.patch, i);
        }
    }
}

WantedAtoms WantedAtomsFinder::find(const AtomName& name, bool is_first, bool is_last) const {
    const Residue& residue = force_field_.residues.at(name.residue);
    WantedAtoms wanted;
    add(residue, std::nullopt, wanted);
    const auto segment = segments_.find(name.segment);
    const auto end_patch = [&](const std::string& asked, const std::string& by_template) {
        apply(asked.empty() ? by_template : asked, 0, wanted);
    };
    static const SegmentSettings by_template;
    const SegmentSettings& ends = segment == segments_.end() ? by_template : *segment->second;
    if (is_first) end_patch(ends.first, residue.first_patch);
    if (is_last) end_patch(ends.last, residue.last_patch);
    if (const auto found = uses_.find({name.segment, name.number}); found != uses_.end()) {
        for (const auto& [patch, place] : found->second) apply(patch, place, wanted);
    }
    return wanted;
}

void WantedAtomsFinder::apply(const std::string& patch, std::size_t place,
                              WantedAtoms& wanted) const {
    const auto found = force_field_.patches.find(patch);
    if (found == force_field_.patches.end()) return;  // completing the atoms says
    for (const std::string& deleted : found->second.deleted_atoms) {
        if (const auto name = own_name(deleted, place)) wanted.elements.erase(*name);
    }
    add(found->second, place, wanted);
}

void WantedAtomsFinder::add(const Residue& residue, std::optional<std::size_t> place,
                            WantedAtoms& wanted) const {
    for (const ResidueAtom& atom : residue.atoms) {
        if (const auto name = own_name(atom.name, place)) {
            wanted.elements[*name] = element_of(force_field_, atom, *name);
        }
    }
    for (const auto& [a, b] : residue.bonds) {
        const auto first = own_name(a, place);
        const auto second = own_name(b, place);
        if (first && second) wanted.bonds.push_back({*first, *second});
    }
    for (const InternalCoordinate& line : residue.internal_coordinates) {
        std::array<std::string, 4> names;
        bool is_whole = true;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto name = own_name(line.atoms[i], place);
            is_whole = is_whole && name.has_value();
            names[i] = name.value_or("");
        }
        if (!is_whole) continue;
        wanted.dihedral_atoms.push_back(names);
        wanted.dihedrals.push_back(line.dihedral_deg * pi / 180);
    }
}

}  // namespace palpa
