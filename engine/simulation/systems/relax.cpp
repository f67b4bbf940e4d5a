#include "simulation/systems/relax.h"

#include "simulation/solver.h"

#include <optional>

namespace palpa {

void relax(World& world, const StepInput& input) {
    const std::optional<RelaxStepReport> relaxed = relax_mobile(world, input);
    if (!relaxed) return;
    StepReport& report = world.write<StepReport>();
    report.relaxed = relaxed;
    report.finite = relaxed->is_finite;
    if (report.finite) copy_positions(world);
}

}  // namespace palpa
