#include "tests/simulation/wind/wind.h"

#include "simulation/held.h"
#include "simulation/resources.h"

namespace palpa {

// The end of a weak spring runs so far before each water that it pulls with this force.
void blow_wind(World& world, const StepInput& /*input*/) {
    constexpr double force = 0.5;  // kcal/mol/Å, 35 pN
    constexpr double k = 0.01;     // kcal/mol/Å^2
    if (!has_mobile(world)) return;
    TorsionState& state = world.resource<TorsionState>();
    std::size_t others = 0;  // springs of hands and restraints, which stand before ours
    world.each<Grip>([&](Entity, const Grip& grip) { others += grip.spring >= 0 ? 1 : 0; });
    world.each<Restraint>([&](Entity, const Restraint&) { ++others; });
    state.springs.resize(others);
    world.each<Molecule>([&](Entity entity, const Molecule& molecule) {
        if (world.resource<AtomTable>().names[molecule.atoms.first].residue != "TIP3") return;
        bool is_held = false;
        world.each<Grip>([&](Entity, const Grip& grip) { is_held |= grip.molecule == entity; });
        if (is_held) return;
        // For each water that no hand holds:
        Spring spring;
        for (std::uint32_t i = 0; i < molecule.atoms.count; ++i)
            spring.atoms.push_back(molecule.atoms.first + i);
        spring.k = k;
        spring.place = find_centre_of_mass(model_of(world), spring.atoms, state.positions) +
                       Vec3(force / k, 0, 0);
        state.springs.push_back(spring);
    });
}

}  // namespace palpa
