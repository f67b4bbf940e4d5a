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

// How far the grabbed molecule goes, and the gain that decided it.
struct Move {
    Vec3 by = Vec3::Zero();  // Å
    double displacement_gain = 0;
};

Move find_move(const Simulation& simulation, const HandPose& hand, const TouchModel& felt,
               const Grab& grab, const Guide& guide) noexcept {
    const double gain = displacement_gain(simulation.laws.displacement, felt.force_newton.norm());
    const Vec3 handle_m = guide.projector * (hand.travel_m - grab.travel_m);
    return {handle_m / gain * units::angstrom_per_metre, gain};
}

}  // namespace

void take_hold(Simulation& simulation, const HandPose& hand) noexcept {
    simulation.world.find<Grab>(simulation.hand)->travel_m = hand.travel_m;
}

StepReport step_simulation(Simulation& simulation, const HandPose& hand,
                           const TouchModel& felt) noexcept {
    const auto begin = std::chrono::steady_clock::now();
    Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Guide* const guide = simulation.world.find<Guide>(grab->molecule);
    const Vec3 before = guide->place;
    const Move move = hand.place_angstrom ? Move{*hand.place_angstrom - before, 0}
                                          : find_move(simulation, hand, felt, *grab, *guide);
    const Vec3 place = before + move.by;
    grab->travel_m = hand.travel_m;
    StepReport report;
    if (!place.allFinite()) {
        report.touch = felt;
        report.finite = false;
        return report;
    }

    report.move = move.by.norm();
    place_grabbed(simulation, place);
    if (simulation.flexible) {
        report.settled = step_flexible(*simulation.flexible);
        copy_positions(*simulation.flexible, simulation.atoms.positions);
        report.finite = report.settled->is_finite;
    }
    if (!report.finite) place_grabbed(simulation, before);
    update_touch(hand, simulation);
    if (!hand.place_angstrom) simulation.touch.model.displacement_gain = move.displacement_gain;
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
