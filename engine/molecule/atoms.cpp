#include "molecule/atoms.h"

#include "core/text.h"
#include "molecule/element.h"

namespace palpa {

std::string to_string(const AtomName& name) {
    return name.segment + " " + name.residue + " " + name.number + " " + name.atom;
}

bool is_same_residue(const AtomName& a, const AtomName& b) noexcept {
    return a.segment == b.segment && a.number == b.number && a.residue == b.residue;
}

double b_factor_of(const Structure& structure, std::size_t atom) noexcept {
    if (!structure.records.empty()) return structure.records[atom].b_factor;
    return structure.weights.empty() ? 0 : structure.weights[atom];
}

std::string find_element(const AtomTable& atoms, std::size_t atom) {
    const std::string& stated = atoms.element[atom];
    if (!stated.empty()) return upper_case(stated);
    return find_element_of_name(atoms.names[atom].atom, atoms.names[atom].residue);
}

std::size_t AtomTable::count_bytes() const noexcept {
    const auto bytes_of = [](const auto&... columns) { return (columns.count_bytes() + ...); };
    return positions.size() * sizeof(Vec3) + bytes_of(names, element, mass, charge, sqrt_epsilon,
                                                      half_rmin, type, b_factor, bonds,
                                                      solvation.volume, solvation.strength,
                                                      solvation.inverse_lambda, solvation.radius);
}

std::vector<AtomRange> list_residues(const AtomTable& atoms, std::span<const AtomRange> molecules) {
    std::vector<AtomRange> residues;
    for (const AtomRange& molecule : molecules) {
        const std::uint32_t end = molecule.first + molecule.count;
        for (std::uint32_t first = molecule.first; first < end;) {
            std::uint32_t next = first + 1;
            while (next < end && is_same_residue(atoms.names[next], atoms.names[first])) ++next;
            residues.push_back({first, next - first});
            first = next;
        }
    }
    return residues;
}

}  // namespace palpa
