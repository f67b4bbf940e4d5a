#include "tests/support/torsion_molecules.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpa::test {

void TorsionCaseBuilder::add_molecule(std::size_t bodies, TorsionShape shape) {
    const auto base = static_cast<std::uint32_t>(case_.bodies.bodies.size());
    std::vector<std::uint32_t> parents{no_body};
    std::vector<std::size_t> children(bodies, 0);
    for (std::uint32_t b = 1; b < bodies; ++b) {
        parents.push_back(parent_of(b, shape));
        ++children[parents.back()];
    }
    case_.bodies.bodies.push_back({});
    add_body_atoms(add_atom(base, Vec3(uniform(-9, 9), uniform(-9, 9), uniform(-9, 9))), base,
                   children[0] + 2);
    for (std::uint32_t b = 1; b < bodies; ++b) {
        const std::uint32_t parent = base + parents[b], body = base + b;
        const std::uint32_t j = any_atom_of(parent), k = add_bonded(j, body);
        case_.bodies.bodies.push_back({parent, {j, k}});
        // Beside the axis there is an atom of this body or the next joint's.
        add_body_atoms(k, body, children[b] == 0 ? 1 : children[b] / 2);
    }
}

std::uint32_t TorsionCaseBuilder::parent_of(std::uint32_t body, TorsionShape shape) {
    if (shape == TorsionShape::Star) return 0;
    if (shape == TorsionShape::Chain) return body - 1;
    // Every second body is a tooth.
    if (shape == TorsionShape::Comb) return body - (body % 2 == 0 ? 2 : 1);
    return static_cast<std::uint32_t>(below(body));
}

std::uint32_t TorsionCaseBuilder::add_atom(std::uint32_t body, const Vec3& position) {
    constexpr std::array weights{1.008, 12.011, 14.007, 15.999, 32.06};
    const auto atom = static_cast<std::uint32_t>(case_.masses.size());
    case_.masses.push_back(weights[below(weights.size())]);
    case_.positions.push_back(position);
    case_.forces.emplace_back(uniform(-20, 20), uniform(-20, 20), uniform(-20, 20));
    case_.bodies.body_of.push_back(body);
    bonded_.emplace_back();
    if (atoms_of_.size() <= body) atoms_of_.resize(body + 1);
    atoms_of_[body].push_back(atom);
    return atom;
}

std::uint32_t TorsionCaseBuilder::add_bonded(std::uint32_t to, std::uint32_t body) {
    Vec3 direction;
    const auto is_crowded = [&] {
        return std::ranges::any_of(bonded_[to], [&](std::uint32_t other) {
            const Vec3 bond = (case_.positions[other] - case_.positions[to]).normalized();
            return std::abs(bond.dot(direction)) > 0.8;
        });
    };
    int attempts = 0;
    do {
        direction = Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    } while (is_crowded() && ++attempts < 1000);
    const std::uint32_t atom = add_atom(body, case_.positions[to] + 1.4 * direction);
    bonded_[to].push_back(atom);
    bonded_[atom].push_back(to);
    return atom;
}

void TorsionCaseBuilder::add_body_atoms(std::uint32_t first, std::uint32_t body,
                                        std::size_t least) {
    const std::size_t count = least + below(5);
    for (std::size_t i = 0; i < count; ++i) {
        add_bonded(i < 2 ? first : any_atom_of(body), body);
    }
}

std::uint32_t TorsionCaseBuilder::any_atom_of(std::uint32_t body) {
    std::vector<std::uint32_t> open;
    for (const std::uint32_t atom : atoms_of_[body]) {
        if (bonded_[atom].size() < 4) open.push_back(atom);
    }
    return open[below(open.size())];
}

TorsionCase torsion_case(std::uint32_t seed, std::size_t bodies, TorsionShape shape) {
    TorsionCaseBuilder builder(seed);
    builder.add_molecule(bodies, shape);
    return builder.take();
}

}  // namespace palpa::test
