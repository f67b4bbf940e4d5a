#include "molecule/atoms.h"

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

}  // namespace palpa
