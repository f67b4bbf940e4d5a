#include "view/residue_structure.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {

std::string name_residue(const AtomTable& atoms, std::span<const ResidueSpan> residues,
                         std::size_t atom, bool is_of_atom) {
    const AtomName& name = atoms.names[atom];
    const bool is_shared = std::ranges::any_of(residues, [&](const ResidueSpan& residue) {
        const AtomName& other = atoms.names[residue.first];
        return other.number == name.number && other.residue == name.residue &&
               other.segment != name.segment;
    });
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
