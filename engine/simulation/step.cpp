// Every step: hand pose to molecule, molecule to forces, forces to touch model.
#include "simulation/step.h"

#include "core/units.h"
#include "simulation/components.h"
#include "simulation/probe.h"
#include "simulation/touch.h"

#include <chrono>
#include <cmath>

namespace palpa {
namespace {

// Where the grabbed molecule goes, and the gain that decided it.
struct Move {
    MoleculePose to;
    double displacement_gain = 0;
};

Move find_move(const Simulation& simulation, const HandPose& hand, const TouchModel& felt,
               const Grab& grab, const Guide& guide) noexcept {
    const double gain = displacement_gain(simulation.laws.displacement, felt.force_newton.norm());
    const Vec3 handle_m = guide.projector * (hand.travel_m - grab.travel_m);
    Move move{{guide.place + handle_m / gain * units::angstrom_per_metre, guide.orientation}, gain};
    if (guide.freedom == 6) {
        const Quat turned = hand.turn * grab.turn.conjugate();
        move.to.orientation = (turned * guide.orientation).normalized();
    }
    return move;
}

// Audits ask about what the servo told where the hand is, in the field of the step before.
void note_told(Simulation& simulation, const HandPose& hand) noexcept {
    if (!simulation.flexible || !simulation.flexible->adaptive) return;
    FewActive& few = *simulation.flexible->adaptive;
    few.told.reset();
    if (!few.exactness || !hand.molecule) return;
    const Touch& touch = simulation.touch;
    few.told = evaluate_local(touch.model, touch.field, *hand.molecule).force_newton /
               units::newton_per_kcal_per_mol_angstrom;
}

}  // namespace

void take_hold(Simulation& simulation, const HandPose& hand) noexcept {
    Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    grab->travel_m = hand.travel_m;
    grab->turn = hand.turn;
}

StepReport step_simulation(Simulation& simulation, const HandPose& hand,
                           const TouchModel& felt) noexcept {
    const auto begin = std::chrono::steady_clock::now();
    Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Guide* const guide = simulation.world.find<Guide>(grab->molecule);
    const MoleculePose before{guide->place, guide->orientation};
    const Move move =
        hand.molecule ? Move{*hand.molecule} : find_move(simulation, hand, felt, *grab, *guide);
    take_hold(simulation, hand);
    StepReport report;
    if (!move.to.place_angstrom.allFinite() || !move.to.orientation.coeffs().allFinite()) {
        report.touch = felt;
        report.finite = false;
        return report;
    }

    report.move = (move.to.place_angstrom - before.place_angstrom).norm();
    note_told(simulation, hand);
    place_grabbed(simulation, move.to);
    if (simulation.flexible) {
        report.settled = step_flexible(*simulation.flexible);
        copy_positions(*simulation.flexible, simulation.atoms.positions);
        report.finite = report.settled->is_finite;
    }
    if (!report.finite) place_grabbed(simulation, before);
    update_touch(hand, simulation);
    if (!hand.molecule) simulation.touch.model.displacement_gain = move.displacement_gain;
    report.touch = simulation.touch.model;
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
