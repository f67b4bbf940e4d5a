#include "simulation/second_order.h"

#include "core/units.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/systems/gather_springs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace palpa {
namespace {

void add_held_atoms(const TorsionModel& model, const TorsionState& state, const HandHold& hold,
                    std::vector<std::uint32_t>& atoms) {
    if (hold.spring) {
        const std::vector<std::uint32_t>& pulled = state.springs[*hold.spring].atoms;
        atoms.insert(atoms.end(), pulled.begin(), pulled.end());
        return;
    }
    for (std::uint32_t i = 0; i < model.masses.size(); ++i) {
        if (model.tree.molecule_of[model.tree.bodies.body_of[i]] == hold.molecule)
            atoms.push_back(i);
    }
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

// The places at which hands have what they hold.
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

// Torque about the origin and force by the model; zero for a hand that it does not have.
Vec6 find_model_pull(const World& world, const SecondOrder& second, Entity hand) noexcept {
    const auto found = std::ranges::find(second.hands, hand);
    if (found == second.hands.end()) return Vec6::Zero();
    Vec6 pull =
        find_hand_pull(second.statics, static_cast<std::size_t>(found - second.hands.begin()));
    pull.head<3>() += held_place(world, hand).cross(Vec3(pull.tail<3>()));
    return pull;
}

}  // namespace

SecondOrder SecondOrder::without_caches() const {
    SecondOrder kept;
    static_cast<SecondOrderPlan&>(kept) = *this;
    kept.statics.renewals.lineariser.held = statics.renewals.lineariser.held;
    kept.lacks_caches = true;
    return kept;
}

std::size_t SecondOrder::count_bytes() const noexcept {
    // Matrices of all coordinates: of the derivatives, their factor, and the model.
    constexpr std::size_t doubles = 8;
    const auto size = static_cast<std::size_t>(statics.at.size());
    return doubles * sizeof(double) * size * size;
}

HeldParts find_held_parts(const World& world, std::vector<Entity>& hands) {
    const TorsionModel& model = model_of(world);
    HeldParts held;
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        if (!is_mobile(world, hand)) return;
        HandHold hold;
        hold.molecule = static_cast<std::uint32_t>(grip.base);
        hold.spring = find_spring_index(world, hand);
        hold.turns = !hold.spring && grip.freedom == 6;
        held.hands.push_back(hold);
        hands.push_back(hand);
        add_held_atoms(model, world.resource<TorsionState>(), hold, held.atoms);
    });
    std::ranges::sort(held.atoms);
    const auto doubles = std::ranges::unique(held.atoms);
    held.atoms.erase(doubles.begin(), doubles.end());
    return held;
}

SecondOrder build_second_order(const QuasiStaticSettings& settings, const World& world) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    SecondOrder second;
    second.settings.forces = settings.forces;
    second.settings.near_reach = s.near_angstrom;
    second.settings.renew_hand = s.renew_angstrom;
    if (s.responses > 0) second.settings.responses = static_cast<std::size_t>(s.responses);
    if (const auto within_pN = find_tolerance(world))
        second.settings.tolerance = *within_pN / units::piconewton_per_kcal_per_mol_angstrom;
    second.most_evaluations = second.settings.evaluations;
    if (!s.renews_beside) second.delay_s = 1e-3 * s.renewal_ms;
    // A renewal beside the steps relaxes a little and linearises anew rather than relaxing long
    // with an old factor: after a snap that is at rest sooner.
    if (s.renews_beside) {
        second.settings.least_relaxation = 4;
        second.settings.most_relaxation = 10;
        second.settings.relax_move = 0.25;
    }
    second.settings.renews_at_once = !s.renews_beside && s.renewal_ms == 0;
    second.statics =
        build_second_order_statics(model_of(world), find_held_parts(world, second.hands));
    return second;
}

void start(World& world, SecondOrder& second) {
    const TorsionModel& model = model_of(world);
    TorsionState& state = world.write<TorsionState>();
    ForceMemory memory;
    update_forces(model, second.settings.forces, memory, state);
    start_second_order(model, second.settings, state, second.statics);
}

void restart(World& world, SecondOrder& second) {
    HeldParts held = second.statics.renewals.lineariser.held;
    second.statics = build_second_order_statics(model_of(world), std::move(held));
}

// The next step linearises.
void restore(World& world, SecondOrder& second) {
    if (!second.lacks_caches) return;
    restart(world, second);
    second.lacks_caches = false;
}

RelaxStepReport relax(World& world, SecondOrder& second, const StepInput& input) {
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

Vec3 find_force(const World& world, const SecondOrder& second, Entity hand) noexcept {
    if (second.statics.linear) return find_model_pull(world, second, hand).tail<3>();
    return find_force_on_held(model_of(world), world.resource<TorsionState>(),
                              held_in_state(world, hand));
}

Vec6 find_pull(const World& world, const SecondOrder& second, Entity hand) noexcept {
    if (second.statics.linear) return find_model_pull(world, second, hand);
    return find_wrench_on(model_of(world), world.resource<TorsionState>(),
                          static_cast<std::size_t>(grip_of(world, hand).base));
}

void note_time(const World& world, const StepReport& report, SecondOrder& second) {
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

}  // namespace palpa
