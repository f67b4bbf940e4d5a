#include "tools/lab/bench/held_model.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace palpa {

TorsionModel build_held_model(const Connectivity& connectivity, const Topology& topology,
                              std::span<const Vec3> positions, const JointRules& rules) {
    const TorsionBodies bodies = build_bodies(connectivity, build_joints(connectivity, rules));
    std::vector<std::uint32_t> first_atom(bodies.bodies.size());
    for (std::size_t i = bodies.body_of.size(); i-- > 0;) {
        first_atom[bodies.body_of[i]] = static_cast<std::uint32_t>(i);
    }
    std::vector<MoleculeBase> bases;
    for (std::size_t body = 0; body < bodies.bodies.size(); ++body) {
        if (bodies.is_base(body)) bases.push_back({BaseFreedom::Held, first_atom[body]});
    }
    return build_torsion_model(bodies, connectivity.mass, {positions.begin(), positions.end()},
                               topology, std::move(bases));
}

}  // namespace palpa
