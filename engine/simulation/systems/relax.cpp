#include "simulation/systems/relax.h"

#include "core/interrupt.h"
#include "core/units.h"
#include "simulation/held.h"
#include "simulation/systems/choose_active.h"
#include "simulation/systems/gather_springs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpa {
namespace {

// Whether a step of the simulation makes another of its own. One that somebody ended is the run's
// last, and nothing of it is felt or recorded.
bool goes_on(const RelaxStepReport& report) { return report.is_finite && noted_interrupt() == 0; }

RelaxStepReport relax_active(World& world, AdaptiveState& adaptive) {
    const TorsionModel& model = model_of(world);
    TorsionState& state = world.write<TorsionState>();
    const std::size_t steps = world.resource<Solver>().settings.steps;
    const AdaptiveSettings& settings = adaptive.settings;
    AdaptiveStatics& statics = adaptive.statics;
    RelaxStepReport report;
    const std::size_t evaluations = statics.memory.evaluations, renewals = statics.renewals;
    const double before = state.energy();
    report.is_finite = update_adaptive_forces(model, settings, state, statics);
    const double moved_by_hand = state.energy();
    report.hand_work = moved_by_hand - before;
    report.steps = adaptive.accuracy ? adaptive.accuracy->work_budget().steps : steps;
    // Many steps where all is at rest leave nothing of h but what rounding did not take.
    if (adaptive.accuracy) statics.h = std::max(statics.h, settings.step.first_h);
    const bool can_move = model.coordinates > 0;
    for (std::size_t i = 0; can_move && i < report.steps && goes_on(report); ++i) {
        const AdaptiveReport step = step_adaptive(model, settings, state, statics);
        report.is_finite = step.step.is_finite;
        report.is_chosen = report.is_chosen || step.is_chosen;
        if (step.step.is_taken) report.largest_move += step.step.largest_move;
    }
    report.energy_change = state.energy() - moved_by_hand;
    report.is_renewed = statics.renewals != renewals;
    report.evaluations = statics.memory.evaluations - evaluations;
    report.active = find_active_freedom(world);
    report.total = statics.selection.total;
    report.neglected = statics.selection.neglected;
    report.is_finite = report.is_finite && std::isfinite(state.energy());
    return report;
}

// A renewal belongs to the state at its request. Nothing where none is used.
std::optional<Renewal> adopt_due(const World& world, const StepInput& input, SecondOrder& second) {
    const bool is_due =
        second.delay_s ? world.resource<Clock>().steps >= second.due : input.adopts_renewal;
    if (!second.statics.pending || !is_due) return {};
    return adopt_pending(model_of(world), second.settings, second.statics);
}

void note_due(const World& world, SecondOrder& second) {
    const Clock& clock = world.resource<Clock>();
    const auto steps =
        static_cast<std::uint64_t>(std::ceil(second.delay_s.value_or(0) / clock.period_s));
    second.due = clock.steps + std::max<std::uint64_t>(steps, 1);
}

// Renewals set energy free one after the other until all is at rest.
void note_snap(const World& world, const RelaxStepReport& report, SecondOrder& second) {
    constexpr double together_s = 0.3;
    if (!(report.released > least_snap)) return;
    const Clock& clock = world.resource<Clock>();
    const bool goes_on =
        second.snap &&
        static_cast<double>(clock.steps - second.snap->step) * clock.period_s < together_s;
    second.snap = {report.snapped_atom, report.released + (goes_on ? second.snap->released : 0),
                   clock.steps};
}

// Where hands have what they hold.
std::vector<MoleculePose> find_places(const World& world, const SecondOrder& second) {
    std::vector<MoleculePose> places;
    for (const Entity hand : second.hands) {
        const Grip& grip = grip_of(world, hand);
        places.push_back({held_place(world, hand), Quat::Identity()});
        if (grip.base >= 0 && holds_whole(world, hand))
            places.back().orientation =
                world.resource<TorsionState>().turns[static_cast<std::size_t>(grip.base)];
    }
    return places;
}

// Hands that lag have what they hold where it is, not where it was to be.
void hold_back(World& world, const SecondOrder& second, std::span<const MoleculePose> wanted) {
    const std::vector<MoleculePose> found = find_places(world, second);
    for (std::size_t i = 0; i < found.size(); ++i) {
        MoleculePose& pose = world.write<Grip>(second.hands[i])->pose;
        pose.place_angstrom += found[i].place_angstrom - wanted[i].place_angstrom;
        const Quat back = found[i].orientation * wanted[i].orientation.conjugate();
        pose.orientation = (back * pose.orientation).normalized();
    }
}

// All joints and bases follow the hands by second order.
RelaxStepReport follow_by_second_order(World& world, const StepInput& input, SecondOrder& second) {
    const TorsionModel& model = model_of(world);
    TorsionState& state = world.write<TorsionState>();
    const double before = second.statics.value.energy;
    const std::optional<Renewal> adopted = adopt_due(world, input, second);
    RelaxStepReport report;
    report.is_finite = !adopted || adopted->linear;
    if (!report.is_finite) return report;
    const std::vector<MoleculePose> wanted = find_places(world, second);
    const bool was_pending = second.statics.pending.has_value();
    const SecondOrderReport step =
        step_second_order(model, second.settings, state, second.statics, input.await_renewal);
    if (step.lags) hold_back(world, second, wanted);
    if (!was_pending || step.is_renewed) note_due(world, second);
    report.released = step.released;
    report.snapped_atom = step.farthest_relaxed;
    if (adopted) {
        const double released = adopted->relaxed.energy_before - adopted->relaxed.energy_after;
        if (released > step.released) report.snapped_atom = adopted->farthest_atom;
        report.released += released;
        report.evaluations += adopted->relaxed.evaluations;
    }
    report.snapped_atom = model_atoms_of(world).number_in_table(report.snapped_atom);
    report.energy_change = -report.released;
    report.hand_work = step.energy + report.released - before;
    report.largest_move = step.largest_move;
    report.evaluations += step.full_evaluations + step.model_evaluations;
    report.active = static_cast<std::size_t>(model.coordinates);
    report.steps = step.model_evaluations;
    report.is_renewed = step.is_renewed || adopted;
    report.model_age = step.age;
    report.estimated_error_pN = units::piconewton_per_kcal_per_mol_angstrom * step.error_estimate;
    report.is_finite = step.is_finite;
    if (report.is_finite) note_snap(world, report, second);
    return report;
}

}  // namespace

void relax(World& world, const StepInput& input) {
    if (!has_mobile(world)) return;
    StepReport& report = world.write<StepReport>();
    report.relaxed = relax_mobile(world, input);
    report.finite = report.relaxed->is_finite;
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

RelaxStepReport relax_mobile(World& world, const StepInput& input) {
    AdaptiveState* const adaptive = world.write_if<AdaptiveState>();
    RelaxStepReport report = adaptive
                                 ? relax_active(world, *adaptive)
                                 : follow_by_second_order(world, input, world.write<SecondOrder>());
    return_ends(world);
    return report;
}

}  // namespace palpa
