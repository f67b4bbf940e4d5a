// Every step: hand pose to molecule, molecule to forces, forces to touch model.
#include "simulation/step.h"

#include "core/units.h"
#include "field/frozen_field.h"
#include "simulation/components.h"
#include "simulation/probe.h"

#include <Eigen/Eigenvalues>
#include <chrono>
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

// What pulls at the hand, in engine units.
struct Pull {
    Vec3 force, torque;
    double stiffness, energy;
};

// In single precision: a step of molecules that move has no time for more.
FieldSum fast_field_on_grabbed(const Simulation& simulation) {
    const FieldPoints group = grabbed_points(simulation);
    const FrozenField field =
        build_frozen_field(group, environment_points(simulation), pair_rule(simulation));
    return evaluate_frozen_field(field, group.positions);
}

// A hand on a spring feels the spring; one that moves a molecule, what all others do to it, with
// the stiffness that it would have if they stayed where they are.
Pull find_pull(const Simulation& simulation, const Grab& grab, const Guide& guide) noexcept {
    if (simulation.flexible && simulation.flexible->state.tether) {
        const Flexible& flexible = *simulation.flexible;
        const Tether& tether = *flexible.state.tether;
        const Vec3 away =
            find_tethered(flexible.model, tether, flexible.state.positions) - tether.place;
        return {tether.k * away, Vec3::Zero(), tether.k, flexible.state.energy()};
    }
    const AtomRange atoms = simulation.world.find<Molecule>(grab.molecule)->atoms;
    FieldSum field =
        simulation.flexible ? fast_field_on_grabbed(simulation) : field_on_grabbed(simulation);
    if (simulation.flexible) {
        // As what moves by itself feels it, with its cutoff.
        const Vec6 wrench = find_pull_on_held(*simulation.flexible);
        field.torque = wrench.head<3>();
        field.force = wrench.tail<3>();
    }
    const Vec3 centre = centre_of_mass(simulation.atoms, atoms);
    return {field.force, field.torque_about(centre), extreme_stiffness(guide, field.stiffness),
            field.energy()};
}

}  // namespace

TouchModel build_touch_model(const Simulation& simulation, const HandPose& hand) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Guide* const guide = simulation.world.find<Guide>(grab->molecule);
    const Pull pull = find_pull(simulation, *grab, *guide);
    TouchModel touch;
    touch.time_s = hand.time_s;
    touch.molecule_angstrom = guide->place;
    touch.force_newton = guide->projector * pull.force * units::newton_per_kcal_per_mol_angstrom;
    touch.torque_newton_metre = pull.torque * units::joule_per_kcal_per_mol;
    touch.stiffness_N_per_m = pull.stiffness * units::newton_per_metre_per_kcal_per_mol_angstrom2;
    touch.displacement_gain =
        displacement_gain(simulation.laws.displacement, touch.force_newton.stableNorm());
    touch.potential_kcal_per_mol = pull.energy;
    touch.active_freedom = guide->freedom;
    if (simulation.flexible)
        touch.active_freedom += static_cast<int>(find_active_freedom(*simulation.flexible));
    touch.period_s = simulation.period_s;
    return touch;
}

void take_hold(Simulation& simulation, const HandPose& hand) noexcept {
    simulation.world.find<Grab>(simulation.hand)->travel_m = hand.travel_m;
}

StepReport step_simulation(Simulation& simulation, const HandPose& hand,
                           const TouchModel& felt) noexcept {
    const auto begin = std::chrono::steady_clock::now();
    Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Guide* const guide = simulation.world.find<Guide>(grab->molecule);
    const Move move = find_move(simulation, hand, felt, *grab, *guide);
    const Vec3 before = guide->place;
    const Vec3 place = before + move.by;
    grab->travel_m = hand.travel_m;
    StepReport report;
    if (!place.allFinite()) {
        report.touch = felt;
        report.finite = false;
        return report;
    }

    report.move = move.by.stableNorm();
    place_grabbed(simulation, place);
    if (simulation.flexible) {
        report.settled = step_flexible(*simulation.flexible);
        copy_positions(*simulation.flexible, simulation.atoms.positions);
        report.finite = report.settled->is_finite;
    }
    report.touch = build_touch_model(simulation, hand);
    report.touch.displacement_gain = move.displacement_gain;
    report.finite = report.finite && report.touch.force_newton.allFinite();
    if (!report.finite) place_grabbed(simulation, before);
    if (report.settled && simulation.flexible) {
        const std::chrono::duration<double, std::micro> took =
            std::chrono::steady_clock::now() - begin;
        note_time(*simulation.flexible, *report.settled, took.count());
    }
    return report;
}

}  // namespace palpa
