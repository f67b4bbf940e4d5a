#include "simulation/observe.h"

#include "core/units.h"
#include "simulation/held.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace palpa {

void note_rendered_force(World& world, const StepInput& input) {
    AdaptiveState* const adaptive = world.write_if<AdaptiveState>();
    if (!adaptive) return;
    adaptive->rendered.reset();
    if (!adaptive->accuracy || !input.hands.front().molecule) return;
    if (!world.find<Grip>(first_hand(world))) return;
    std::vector<std::optional<LiveMolecule>> live;
    for (const HandPose& hand : input.hands) {
        live.emplace_back();
        if (hand.molecule) live.back() = {*hand.molecule, hand.start};
    }
    const LocalContactModel& contact = local_contact_of(world);
    adaptive->rendered =
        evaluate_local(contact.model, contact.field, *input.hands.front().molecule, live)
            .force_newton /
        units::newton_per_kcal_per_mol_angstrom;
}

void find_error(World& world) {
    ErrorEstimate* const estimate = world.write_if<ErrorEstimate>();
    const Entity hand = first_hand(world);
    const Grip* const grip = world.find<Grip>(hand);
    if (!estimate || !grip || !is_mobile(world, hand)) return;
    const TorsionModel& model = model_of(world);
    if (!estimate->memory) {
        estimate->memory = {build_lineariser(model, estimate->held), build_quasi_statics(model),
                            nullptr};
    }
    const Renewal rest =
        make_renewal(model, estimate->settings,
                     {world.resource<TorsionState>(), 0, 0, {}, {}, {}, {}}, *estimate->memory);
    if (!rest.linear) return;
    const AdaptiveState* const adaptive = world.find_resource<AdaptiveState>();
    const Vec3 felt =
        adaptive && adaptive->rendered ? *adaptive->rendered : find_force_on_held(world, hand);
    const Vec3 found =
        find_force_on_held(model_of(world), rest.linear->at, held_in_state(world, hand));
    constexpr double pN = units::piconewton_per_kcal_per_mol_angstrom;
    estimate->last_pN = pN * (felt - found).norm();
    estimate->felt_pN = pN * felt;
    // Second derivatives cost about as much as so many evaluations.
    constexpr std::size_t linearisation = 10;
    estimate->evaluations = rest.relaxed.evaluations + linearisation;
}

void estimate_error(World& world) {
    ErrorEstimate* const estimate = world.write_if<ErrorEstimate>();
    std::optional<RelaxStepReport>& report = world.write<StepReport>().relaxed;
    if (!estimate || !report || !report->is_finite) return;
    AdaptiveState* const adaptive = world.write_if<AdaptiveState>();
    AccuracyController* const accuracy =
        adaptive && adaptive->accuracy ? &*adaptive->accuracy : nullptr;
    if (accuracy) accuracy->add_step({report->active, report->steps});
    constexpr std::size_t every = 200;  // steps, where nobody asks for an accuracy
    ++estimate->steps;
    if (accuracy ? !accuracy->is_due() : estimate->steps % every != 0) return;
    estimate->last_pN.reset();
    find_error(world);
    report->is_estimating = true;
    report->estimated_error_pN = estimate->last_pN;
    if (accuracy && estimate->last_pN)
        accuracy->add_estimate(*estimate->last_pN, estimate->felt_pN, estimate->evaluations);
}

namespace {

void note_evaluations(const World& world, const StepReport& report, SecondOrder& second) {
    constexpr double of_period = 0.8, newest = 0.1;
    if (second.delay_s || report.relaxed->is_renewed || report.relaxed->steps == 0) return;
    const double us = report.took_us / static_cast<double>(report.relaxed->steps);
    double& mean_us = second.evaluation_us;
    // One step that the machine interrupts says little.
    mean_us += mean_us > 0 ? newest * (std::min(us, 2 * mean_us) - mean_us) : us;
    const double fit = of_period * 1e6 * world.resource<Clock>().period_s / std::max(mean_us, 1.0);
    // With one alone nothing relaxes.
    second.settings.evaluations = static_cast<std::size_t>(std::lround(
        std::clamp(fit, 2.0, std::max(2.0, static_cast<double>(second.most_evaluations)))));
}

}  // namespace

void note_time(World& world) {
    SecondOrder* const second = world.write_if<SecondOrder>();
    if (second && world.resource<StepReport>().relaxed)
        note_evaluations(world, world.resource<StepReport>(), *second);
    AdaptiveState* const adaptive = world.write_if<AdaptiveState>();
    const StepReport& report = world.resource<StepReport>();
    if (!adaptive || !adaptive->budget || !report.relaxed || report.relaxed->is_estimating) return;
    if (report.relaxed->is_chosen || report.relaxed->is_renewed) {
        adaptive->budget->add_choice(report.took_us);
    } else {
        adaptive->budget->add_step(report.took_us);
    }
}

}  // namespace palpa
