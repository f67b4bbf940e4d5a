#include "view/residue_structure.h"

#include <fmt/format.h>
#include <map>

namespace palpa {

ResidueNames::ResidueNames(const AtomTable& atoms, std::span<const ResidueSpan> residues)
    : atoms_(atoms) {
    std::map<NameAndNumber, std::string_view> segments;
    for (const ResidueSpan& residue : residues) {
        const AtomName& name = atoms.names[residue.first];
        const NameAndNumber key{name.residue, name.number};
        if (segments.try_emplace(key, name.segment).first->second != name.segment)
            shared_.insert(key);
    }
}

std::string ResidueNames::name(std::size_t atom, bool is_of_atom) const {
    const AtomName& name = atoms_.names[atom];
    const bool is_shared = shared_.contains({name.residue, name.number});
    return fmt::format("{}{} {}{}{}", is_shared ? name.segment + ":" : std::string(), name.residue,
                       name.number, is_of_atom ? " " : "", is_of_atom ? name.atom : std::string());
}

std::size_t find_atom(const AtomTable& atoms, const ResidueSpan& residue, std::string_view name) {
    std::size_t i = residue.first;
    while (i < residue.end && atoms.names[i].atom != name) ++i;
    return i;
}

Backbone find_backbone(const AtomTable& atoms, std::span<const ResidueSpan> residues) {
    Backbone found;
    for (std::size_t i = 0; i < residues.size(); ++i) {
        const ResidueSpan& residue = residues[i];
        if (residue.alpha == residue.end) continue;
        const std::size_t n = find_atom(atoms, residue, "N"), c = find_atom(atoms, residue, "C");
        std::size_t o = find_atom(atoms, residue, "O");
        if (o == residue.end) o = find_atom(atoms, residue, "OT1");
        if (n == residue.end || c == residue.end || o == residue.end) continue;
        const auto& places = atoms.positions;
        BackboneResidue backbone{places[n], places[residue.alpha], places[c], places[o]};
        const AtomName& name = atoms.names[n];
        backbone.is_proline = name.residue == "PRO" || name.residue == "HYP";
        backbone.follows = i > 0 && !found.numbers.empty() && found.numbers.back() == i - 1 &&
                           atoms.names[residues[i - 1].alpha].segment == name.segment &&
                           is_peptide_bond(found.residues.back().c, backbone.n);
        found.residues.push_back(backbone);
        found.numbers.push_back(i);
    }
    return found;
}

std::vector<SecondaryStructure> per_atom(const AtomTable& atoms,
                                         std::span<const ResidueSpan> residues,
                                         std::span<const SecondaryStructure> structure) {
    std::vector<SecondaryStructure> of_atoms(atoms.size(), SecondaryStructure::Coil);
    for (std::size_t i = 0; i < residues.size(); ++i)
        for (std::size_t atom = residues[i].first; atom < residues[i].end; ++atom)
            of_atoms[atom] = structure[i];
    return of_atoms;
}

std::span<const SecondaryStructure> ResidueStructure::update(
    const AtomTable& atoms, std::span<const ResidueSpan> residues) {
    const Backbone backbone = find_backbone(atoms, residues);
    const std::span<const SecondaryStructure> found = cache_.update(backbone.residues);
    structure_.assign(residues.size(), SecondaryStructure::Coil);
    for (std::size_t i = 0; i < found.size(); ++i) structure_[backbone.numbers[i]] = found[i];
    return structure_;
}

}  // namespace palpa
