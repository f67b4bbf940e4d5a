#include "tests/simulation/wind/wind.h"

#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/systems/gather_springs.h"

#include <vector>

namespace palpa {
namespace {

// Waters that no hand holds.
std::vector<Entity> find_waters(const World& world) {
    std::vector<Entity> waters;
    world.each<Molecule>([&](Entity entity, const Molecule& molecule) {
        bool is_held = false;
        world.each<Grip>([&](Entity, const Grip& grip) { is_held |= grip.molecule == entity; });
        const AtomName& name = world.resource<AtomTable>().names[molecule.atoms.first];
        if (name.residue == "TIP3" && !is_held) waters.push_back(entity);
    });
    return waters;
}

}  // namespace

// The end of a weak spring runs so far before each water that it pulls with this force.
void blow_wind(World& world, const StepInput& /*input*/) {
    constexpr double force = 0.5;  // kcal/mol/Å, 35 pN
    constexpr double k = 0.01;     // kcal/mol/Å^2
    const Entity wind = make_owner<Wind>(world);
    for (const Entity spring : find_springs(world, wind)) world.destroy(spring);
    for (const Entity water : find_waters(world)) {
        const AtomsOf atoms{water, all_atoms_of(world, water)};
        const Vec3 end = middle_of(world, atoms) + Vec3(force / k, 0, 0);
        world.set(world.create(), Spring{{atoms}, end, k, 0, wind});
    }
}

}  // namespace palpa
