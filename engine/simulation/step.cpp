// Every step: hand pose to molecule, molecule to forces, forces to touch model.
#include "simulation/step.h"

#include "core/units.h"
#include "simulation/components.h"
#include "simulation/probe.h"

#include <cmath>

namespace palpa {
namespace {

// Å that the grabbed molecule goes along its line, and the gain that decided it.
struct LineMove {
    double distance = 0;
    double displacement_gain = 0;
};

LineMove find_move(const Simulation& simulation, const HandPose& hand, const TouchModel& felt,
                   const Grab& grab, const LineGuide& guide) noexcept {
    const double gain =
        displacement_gain(simulation.laws.displacement, felt.force_newton.dot(guide.axis));
    const double handle_m = (hand.travel_m - grab.travel_m).dot(guide.axis);
    return {handle_m / gain * units::angstrom_per_metre, gain};
}

}  // namespace

TouchModel build_touch_model(const Simulation& simulation, const HandPose& hand) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const LineGuide* const guide = simulation.world.find<LineGuide>(grab->molecule);
    const LineForce line = force_along_line(simulation);
    TouchModel touch;
    touch.time_s = hand.time_s;
    touch.molecule_angstrom = guide->distance * guide->axis;
    touch.force_newton = line.force * units::newton_per_kcal_per_mol_angstrom * guide->axis;
    touch.stiffness_N_per_m = line.stiffness * units::newton_per_metre_per_kcal_per_mol_angstrom2;
    touch.displacement_gain =
        displacement_gain(simulation.laws.displacement, touch.force_newton.dot(guide->axis));
    touch.potential_kcal_per_mol = line.energy;
    touch.active_freedom = 1;
    touch.period_s = simulation.period_s;
    return touch;
}

void take_hold(Simulation& simulation, const HandPose& hand) noexcept {
    simulation.world.find<Grab>(simulation.hand)->travel_m = hand.travel_m;
}

StepReport step_simulation(Simulation& simulation, const HandPose& hand,
                           const TouchModel& felt) noexcept {
    Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const LineGuide* const guide = simulation.world.find<LineGuide>(grab->molecule);
    const LineMove move = find_move(simulation, hand, felt, *grab, *guide);
    const double distance = guide->distance + move.distance;
    grab->travel_m = hand.travel_m;
    if (!std::isfinite(distance)) return {felt, 0, false};

    const double before = guide->distance;
    move_grabbed(simulation, distance);
    StepReport report{build_touch_model(simulation, hand), move.distance, true};
    report.touch.displacement_gain = move.displacement_gain;
    if (!report.touch.force_newton.allFinite()) {
        move_grabbed(simulation, before);
        report.finite = false;
    }
    return report;
}

}  // namespace palpa
