// Every step: hand pose to molecule, molecule to forces, forces to touch model.
#include "simulation/step.h"

#include "core/units.h"
#include "simulation/components.h"
#include "simulation/probe.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace palpa {
namespace {

// How far the grabbed molecule goes, and the gain that decided it.
struct Move {
    Vec3 by = Vec3::Zero();  // Å
    double displacement_gain = 0;
};

Move find_move(const Simulation& simulation, const HandPose& hand, const TouchModel& felt,
               const Grab& grab, const Guide& guide) noexcept {
    const double gain =
        displacement_gain(simulation.laws.displacement, felt.force_newton.stableNorm());
    const Vec3 handle_m = guide.projector * (hand.travel_m - grab.travel_m);
    return {handle_m / gain * units::angstrom_per_metre, gain};
}

// The eigenvalue of largest magnitude of what the molecule's freedom leaves of a stiffness.
double extreme_stiffness(const Guide& guide, const Mat3& stiffness) noexcept {
    const Mat3 free = guide.projector * stiffness * guide.projector;
    const Vec3 eigenvalues =
        Eigen::SelfAdjointEigenSolver<Mat3>(free, Eigen::EigenvaluesOnly).eigenvalues();
    const double lowest = eigenvalues(0), highest = eigenvalues(2);
    return std::abs(lowest) > std::abs(highest) ? lowest : highest;
}

}  // namespace

TouchModel build_touch_model(const Simulation& simulation, const HandPose& hand) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Guide* const guide = simulation.world.find<Guide>(grab->molecule);
    const FieldSum field = field_on_grabbed(simulation);
    const Vec3 centre = grabbed_points(simulation).positions[0] - simulation.grabbed_shape[0] +
                        simulation.grabbed_centre;
    TouchModel touch;
    touch.time_s = hand.time_s;
    touch.molecule_angstrom = guide->place;
    touch.force_newton = guide->projector * field.force * units::newton_per_kcal_per_mol_angstrom;
    touch.torque_newton_metre = field.torque_about(centre) * units::joule_per_kcal_per_mol;
    touch.stiffness_N_per_m = extreme_stiffness(*guide, field.stiffness) *
                              units::newton_per_metre_per_kcal_per_mol_angstrom2;
    touch.displacement_gain =
        displacement_gain(simulation.laws.displacement, touch.force_newton.stableNorm());
    touch.potential_kcal_per_mol = field.energy();
    touch.active_freedom = guide->freedom;
    touch.period_s = simulation.period_s;
    return touch;
}

void take_hold(Simulation& simulation, const HandPose& hand) noexcept {
    simulation.world.find<Grab>(simulation.hand)->travel_m = hand.travel_m;
}

StepReport step_simulation(Simulation& simulation, const HandPose& hand,
                           const TouchModel& felt) noexcept {
    Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Guide* const guide = simulation.world.find<Guide>(grab->molecule);
    const Move move = find_move(simulation, hand, felt, *grab, *guide);
    const Vec3 before = guide->place;
    const Vec3 place = before + move.by;
    grab->travel_m = hand.travel_m;
    if (!place.allFinite()) return {felt, 0, false};

    place_grabbed(simulation, place);
    StepReport report{build_touch_model(simulation, hand), move.by.stableNorm(), true};
    report.touch.displacement_gain = move.displacement_gain;
    if (!report.touch.force_newton.allFinite()) {
        place_grabbed(simulation, before);
        report.finite = false;
    }
    return report;
}

}  // namespace palpa
