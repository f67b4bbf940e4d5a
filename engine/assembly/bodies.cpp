#include "assembly/bodies.h"

#include "assembly/bridges.h"

#include <algorithm>

namespace palpa {
namespace {

enum class Motion : std::uint8_t { Rigid, Turns, Cut };

std::vector<Motion> motions_of(const Connectivity& connectivity, const Joints& joints) {
    std::vector<std::array<std::uint32_t, 2>> turning, cut = joints.springs;
    for (const Joint& joint : joints.joints) turning.push_back(joint.bond);
    std::ranges::sort(turning);
    std::ranges::sort(cut);
    std::vector<Motion> motions;
    for (const auto& [a, b] : connectivity.bonds) {
        const std::array bond{std::min(a, b), std::max(a, b)};
        Motion motion = Motion::Rigid;
        if (std::ranges::binary_search(turning, bond)) motion = Motion::Turns;
        if (std::ranges::binary_search(cut, bond)) motion = Motion::Cut;
        motions.push_back(motion);
    }
    return motions;
}

}  // namespace

std::size_t TorsionBodies::molecules() const noexcept {
    return static_cast<std::size_t>(
        std::ranges::count(bodies, no_body, [](const Body& body) { return body.parent; }));
}

TorsionBodies build_bodies(const Connectivity& connectivity, const Joints& joints,
                           std::span<const std::uint32_t> base_atoms) {
    const std::size_t atoms = connectivity.mass.size();
    const Neighbours neighbours(atoms, connectivity.bonds);
    const std::vector<Motion> motions = motions_of(connectivity, joints);
    TorsionBodies result;
    result.springs = joints.springs;
    result.body_of.assign(atoms, no_body);
    std::vector<Body> waiting;  // their joints are known, their atoms not yet
    std::vector<std::uint32_t> reached;
    const auto add_body = [&](const Body& body, std::uint32_t first_atom) {
        const auto number = static_cast<std::uint32_t>(result.bodies.size());
        result.bodies.push_back(body);
        result.body_of[first_atom] = number;
        reached.assign(1, first_atom);
        while (!reached.empty()) {
            const std::uint32_t atom = reached.back();
            reached.pop_back();
            for (const Neighbour to : neighbours.of(atom)) {
                if (motions[to.bond] == Motion::Cut || result.body_of[to.atom] != no_body) continue;
                if (motions[to.bond] == Motion::Turns) {
                    waiting.push_back({number, {atom, to.atom}});
                } else {
                    result.body_of[to.atom] = number;
                    reached.push_back(to.atom);
                }
            }
        }
    };
    const auto add_molecule = [&](std::uint32_t atom) {
        if (result.body_of[atom] != no_body) return;
        add_body({}, atom);
        while (!waiting.empty()) {
            const Body next = waiting.back();
            waiting.pop_back();
            add_body(next, next.axis[1]);
        }
    };
    for (const std::uint32_t atom : base_atoms) add_molecule(atom);
    for (std::uint32_t atom = 0; atom < atoms; ++atom) add_molecule(atom);
    return result;
}

std::vector<std::uint32_t> molecules_of(const TorsionBodies& bodies) {
    std::vector<std::uint32_t> molecules;
    std::uint32_t count = 0;
    for (const Body& body : bodies.bodies) {
        molecules.push_back(body.parent == no_body ? count++ : molecules[body.parent]);
    }
    return molecules;
}

}  // namespace palpa
