// Forces of a client on a whole molecule.
#pragma once
#include "ecs/world.h"
#include "simulation/client_pull.h"
#include "simulation/components.h"
#include "simulation/resources.h"

#include <cstdint>

namespace palpa::test {

// A force (kcal/mol/Å) shared by its atoms according to their masses, so that it does not turn.
inline ClientPull pull_molecule(const World& world, Entity molecule, const Vec3& force) {
    const AtomTable& table = world.resource<AtomTable>();
    const AtomRange range = world.find<Molecule>(molecule)->atoms;
    ClientPull pull{{}, {}, table.size()};
    double mass = 0;
    for (std::uint32_t i = 0; i < range.count; ++i) mass += table.mass[range.first + i];
    for (std::uint32_t i = 0; i < range.count; ++i) {
        pull.atoms.push_back(range.first + i);
        pull.forces.emplace_back(table.mass[range.first + i] / mass * force);
    }
    return pull;
}

}  // namespace palpa::test
