#include "ligands/type_traits.h"

#include <cmath>
#include <cstdint>

namespace palpa {
namespace {

double pi_bonds(const ModelCompound& compound, std::uint32_t atom) {
    double pi = 0;
    for (const std::uint32_t bond : compound.seen.bonds[atom]) {
        const BondKind kind = compound.seen.kinds[bond];
        if (kind == BondKind::Triple) pi = 2;
        if (kind == BondKind::Double) ++pi;
        if ((kind == BondKind::Aromatic || kind == BondKind::Resonance) && pi < 1) pi = 1;
    }
    return std::min(pi, 2.0);
}

bool is_halogen(const std::string& element) {
    return element == "F" || element == "CL" || element == "BR" || element == "I";
}

double between_elements(const std::string& a, const std::string& b) {
    if (a == b) return 0;
    if (a == "H" || b == "H") return TypeDistances::unlike;
    if (is_halogen(a) && is_halogen(b)) return 20;
    if ((a == "O" && b == "S") || (a == "S" && b == "O")) return 35;
    return is_halogen(a) || is_halogen(b) ? 100 : 50;
}

}  // namespace

TypeDistances::TypeDistances(std::span<const ModelCompound> compounds) {
    for (const ModelCompound& compound : compounds) {
        for (std::uint32_t i = 0; i < compound.graph.size(); ++i) {
            TypeTraits& traits = traits_[compound.types[i]];
            traits.element = compound.graph.atoms[i].element;
            ++traits.atoms;
            traits.bonds += static_cast<double>(compound.seen.bonds[i].size());
            for (const std::uint32_t bond : compound.seen.bonds[i]) {
                const std::uint32_t other = other_end(compound.graph.bonds[bond], i);
                traits.hydrogens += compound.graph.is_hydrogen(other) ? 1 : 0;
            }
            traits.pi += pi_bonds(compound, i);
            traits.aromatic += compound.seen.is_aromatic[i] ? 1 : 0;
            const auto& rings = compound.seen.in_ring_of[i];
            traits.small_ring += rings[3] || rings[4] ? 1 : 0;
            traits.five_ring += rings[5] ? 1 : 0;
            traits.six_ring += rings[6] ? 1 : 0;
            traits.charge += compound.seen.charge[i];
        }
    }
    for (auto& [type, traits] : traits_) {
        for (double* const sum :
             {&traits.bonds, &traits.hydrogens, &traits.pi, &traits.aromatic, &traits.small_ring,
              &traits.five_ring, &traits.six_ring, &traits.charge}) {
            *sum /= traits.atoms;
        }
    }
}

double TypeDistances::between(const std::string& a, const std::string& b) const {
    if (a == b) return 0;
    const auto first = traits_.find(a), second = traits_.find(b);
    if (first == traits_.end() || second == traits_.end()) return unlike;
    const TypeTraits& x = first->second;
    const TypeTraits& y = second->second;
    const auto gap = [](double one, double other) { return std::abs(one - other); };
    return 1 + between_elements(x.element, y.element) + 8 * gap(x.bonds, y.bonds) +
           2 * gap(x.hydrogens, y.hydrogens) + 12 * gap(x.pi, y.pi) +
           5 * gap(x.aromatic, y.aromatic) + 12 * gap(x.small_ring, y.small_ring) +
           5 * gap(x.five_ring, y.five_ring) + 3 * gap(x.six_ring, y.six_ring) +
           6 * gap(x.charge, y.charge);
}

}  // namespace palpa
