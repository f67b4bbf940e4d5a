#include "simulation/systems/relax.h"

#include "simulation/grip_queries.h"
#include "simulation/solver.h"

#include <cstdint>
#include <optional>

namespace palpa {

void relax(World& world, const StepInput& input) {
    const std::optional<RelaxStepReport> relaxed = relax_mobile(world, input);
    if (!relaxed) return;
    StepReport& report = world.write<StepReport>();
    report.relaxed = relaxed;
    report.finite = relaxed->is_finite;
    if (!report.finite) return;
    copy_positions(world);
    const TorsionState& state = world.resource<TorsionState>();
    world.write_each<Pose, Molecule>([&](Entity, Pose& pose, const Molecule& molecule) {
        const TorsionModel& model = model_of(world);
        const auto atom = model_atoms_of(world).in_model(molecule.reference_atom);
        if (!atom) return;  // it is fixed
        const std::uint32_t body = model.tree.bodies.body_of[*atom];
        pose = {state.positions[*atom], state.turns[model.tree.molecule_of[body]]};
    });
}

}  // namespace palpa
