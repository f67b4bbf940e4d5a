#include "simulation/select_in_world.h"

#include "simulation/components.h"
#include "simulation/held.h"

#include <cstdint>

namespace palpa {

std::vector<bool> select_in_world(const World& world, const Selection& selection,
                                  std::span<const SecondaryStructure> structure) {
    std::vector<NamedRange> molecules;
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        molecules.push_back({molecule.name, molecule.atoms});
    });
    std::vector<std::uint32_t> held;
    for (const Entity hand : find_hands(world)) {
        const std::vector<std::uint32_t> atoms = held_atoms(world, hand);
        held.insert(held.end(), atoms.begin(), atoms.end());
    }
    return select_atoms(selection, {world.resource<AtomTable>(), molecules, held, structure, {}});
}

}  // namespace palpa
