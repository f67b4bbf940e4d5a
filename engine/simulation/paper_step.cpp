#include "simulation/paper_step.h"

#include "core/interrupt.h"
#include "core/units.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/second_order.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace palpa {
namespace {

AdaptiveSettings build_adaptive_settings(const StaticsDescription& s,
                                         const QuasiStaticSettings& step) {
    AdaptiveSettings settings;
    settings.step = step;
    settings.limits.degrees_of_freedom = static_cast<std::size_t>(s.active);
    settings.choose_every = static_cast<std::size_t>(s.choose_every);
    if (s.weights != JointWeights::Acceleration) {
        settings.weight = MetricWeight::Inertia;
        settings.limits.shape = SelectionShape::Single;
    }
    return settings;
}

// A joint that turns half a chain makes all its pairs change; its factor falls with the third power
// of the atoms behind it, and that of a free base as if all were.
std::vector<double> find_mobility_weights(const TorsionModel& model) {
    const AssemblyTree& tree = model.tree;
    const std::vector<Body>& bodies = tree.bodies.bodies;
    std::vector<double> behind(bodies.size(), 0), mobility_weights;
    for (std::size_t b = bodies.size(); b-- > 0;) {
        behind[b] += tree.first_atom[b + 1] - tree.first_atom[b];
        if (!tree.bodies.is_base(b)) behind[bodies[b].parent] += behind[b];
    }
    for (const double atoms : behind) {
        mobility_weights.push_back(1 / ((1 + atoms / 20) * (1 + atoms * atoms / 100)));
    }
    return mobility_weights;
}

// ---- the choice ---------------------------------------------------------------------------------

// The centre of mass of a molecule of the model.
Vec3 find_centre(const World& world, std::size_t molecule) {
    const TorsionModel& model = model_of(world);
    const std::vector<Vec3>& positions = world.resource<TorsionState>().positions;
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (model.tree.molecule_of[model.tree.bodies.body_of[i]] == molecule)
            sum += model.masses[i] * positions[i];
    }
    return sum / model.molecule_masses[molecule];
}

// The region of what a hand holds: the atoms at its spring, or a molecule as large as it was at the
// last choice.
Ball find_ball(const World& world, Entity hand, const AdaptiveStatics& statics) {
    if (const ModelSpring* const spring = spring_of(world, hand)) {
        const std::vector<Vec3>& positions = world.resource<TorsionState>().positions;
        return {find_centre_of_mass(model_of(world), spring->atoms, positions), 0};
    }
    const auto base = static_cast<std::size_t>(grip_of(world, hand).base);
    return {find_centre(world, base), statics.whole.gyration[base]};
}

// Finds the regions around what hands hold; none before accelerations were computed.
std::vector<Ball> find_balls(const World& world, const AdaptiveStatics& statics) {
    std::vector<Ball> balls;
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        if (grip.base < 0 || (!statics.is_built && holds_whole(world, hand))) return;
        balls.push_back(find_ball(world, hand, statics));
    });
    return balls;
}

bool is_about(const std::vector<Ball>& balls, const std::vector<Ball>& before) {
    constexpr double about = 0.5;  // Å
    return balls.size() == before.size() &&
           std::equal(balls.begin(), balls.end(), before.begin(), [](const Ball& a, const Ball& b) {
               return (a.centre - b.centre).norm() < about;
           });
}

double nearness_of(const Vec3& place, const std::vector<Ball>& balls) {
    constexpr double reach2 = 25;  // Å^2
    double most = 0;
    for (const auto& [centre, radius] : balls) {
        const double beyond = std::max(0.0, (place - centre).norm() - radius);
        const double nearness = reach2 / (reach2 + beyond * beyond);
        most = std::max(most, nearness * nearness);
    }
    return most;
}

// Weighs each joint: less than half from 5 Å on around what is held, then less and less. The
// factors stay while that moves little, for with the same factors a choice costs less.
void update_factors(const World& world, PaperStep& paper) {
    const TorsionModel& model = model_of(world);
    const std::vector<Vec3>& positions = world.resource<TorsionState>().positions;
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    std::vector<double>& factors = paper.settings.factors;
    std::vector<Ball> balls = find_balls(world, paper.statics);
    if (!balls.empty() && is_about(balls, paper.near_to)) return;
    paper.near_to = std::move(balls);
    factors = paper.mobility_weights;
    if (paper.near_to.empty()) return;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (model.tree.bodies.is_base(b)) continue;
        factors[b] *= nearness_of(positions[bodies[b].axis[1]], paper.near_to);
    }
}

// Sets how many degrees of freedom may be active, their weights, and when they are selected next.
// Relaxation, which has the accelerations, makes the selection itself.
void prepare_choice(const World& world, PaperStep& paper) {
    const std::size_t together = paper.steps;
    if (paper.weighs_hand_proximity) update_factors(world, paper);
    auto most = static_cast<std::size_t>(model_of(world).coordinates);
    if (paper.accuracy) {
        const WorkBudget& work_budget = paper.accuracy->work_budget();
        most = paper.settings.limits.degrees_of_freedom = work_budget.active;
        // More steps are of the same moment, in which no others have to be chosen.
        paper.settings.choose_every = paper.choose_every * work_budget.steps / together;
    }
    if (!paper.budget) return;
    paper.settings.limits.degrees_of_freedom = paper.budget->find_freedom(most);
    // The budget is for as many quasi-static steps as make one of the simulation.
    const std::size_t usual = paper.choose_every;
    paper.settings.choose_every =
        std::max(usual, together * paper.budget->find_interval(usual / together));
}

// ---- the rest -----------------------------------------------------------------------------------

// Copies what a rebuilt state goes on with.
void keep_history(const AdaptiveStatics& from, AdaptiveStatics& to) {
    to.h = from.h;
    to.is_guided = from.is_guided;
    to.steps_since_choice = from.steps_since_choice;
    to.choices = from.choices;
    to.renewals = from.renewals;
    to.rebuilds = from.rebuilds;
    to.memory.evaluations = from.memory.evaluations;
}

std::size_t find_steps(const PaperStep& paper) {
    return paper.accuracy ? paper.accuracy->work_budget().steps : paper.steps;
}

// True if a step of the simulation makes another of its own. A step that somebody interrupted is
// the run's last, and nothing of it is felt or recorded.
bool goes_on(const RelaxStepReport& report) { return report.is_finite && noted_interrupt() == 0; }

}  // namespace

ErrorEstimate ErrorEstimate::without_caches() const {
    return {settings, held, {}, steps, last_pN, felt_pN, evaluations};
}

PaperStep PaperStep::without_caches() const {
    PaperStep kept;
    static_cast<PaperPlan&>(kept) = *this;
    keep_history(statics, kept.statics);
    kept.lacks_caches = true;
    if (estimate) kept.estimate = estimate->without_caches();
    return kept;
}

std::size_t PaperStep::count_bytes() const noexcept {
    // Pairs and their tiles, trial states and assembly: measured on HIV protease.
    constexpr std::size_t per_atom = 3000;
    return per_atom * statics.across_forces.size();
}

PaperStep build_paper_step(const QuasiStaticSettings& settings, const TorsionModel& model,
                           std::span<const HeldPart> held, const World& world) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    PaperStep paper;
    paper.settings = build_adaptive_settings(s, settings);
    paper.steps = static_cast<std::size_t>(s.steps);
    paper.statics = build_adaptive_statics(model);
    paper.weighs_hand_proximity = s.weights == JointWeights::HandProximity;
    if (paper.weighs_hand_proximity) {
        paper.mobility_weights = find_mobility_weights(model);
        // The part in the hand weighs nothing.
        for (const HeldPart& part : held) paper.mobility_weights[model.tree.bases[part.base]] = 1;
        paper.settings.factors = paper.mobility_weights;
    }
    paper.choose_every = paper.settings.choose_every;
    if (s.budget_us) paper.budget.emplace(*s.budget_us);
    if (const auto within_pN = find_tolerance(world)) {
        paper.accuracy.emplace(
            *within_pN, WorkBudget{paper.settings.limits.degrees_of_freedom, paper.steps},
            static_cast<std::size_t>(model.coordinates), paper.budget.has_value());
    }
    return paper;
}

ErrorEstimate build_error_estimate(const QuasiStaticSettings& settings, const World& world) {
    ErrorEstimate estimate;
    ForceSettings& forces = estimate.settings.forces = settings.forces;
    if (world.resource<ForceFieldInUse>().description.solvent == Solvent::None) {
        const double coulomb = forces.nonbonded.coulomb_constant;
        forces.nonbonded = {};
        forces.nonbonded.coulomb_constant = coulomb;
    }
    estimate.settings.relaxed = 0.1;
    estimate.settings.most_relaxation = 500;
    std::vector<Entity> hands;
    estimate.held = find_held_parts(world, hands);
    return estimate;
}

void start(World& world, PaperStep& paper) {
    prepare_choice(world, paper);
    world.each<Grip>([&](Entity hand, const Grip& grip) {
        if (grip.base >= 0 && holds_whole(world, hand))
            paper.statics.is_guided[static_cast<std::size_t>(grip.base)] = 1;
    });
    // The first step reports what is not finite.
    (void)update_adaptive_forces(model_of(world), paper.settings, world.write<TorsionState>(),
                                 paper.statics);
}

void restart(World& world, PaperStep& paper) {
    paper.statics = build_adaptive_statics(model_of(world));
    paper.near_to.clear();
}

void restore(World& world, PaperStep& paper) {
    if (!paper.lacks_caches) return;
    AdaptiveStatics statics = build_adaptive_statics(model_of(world));
    keep_history(paper.statics, statics);
    paper.statics = std::move(statics);
    paper.lacks_caches = false;
    (void)update_adaptive_forces(model_of(world), paper.settings, world.write<TorsionState>(),
                                 paper.statics);
}

RelaxStepReport relax(World& world, PaperStep& paper, const StepInput& /*input*/) {
    if (paper.statics.steps_since_choice + find_steps(paper) > paper.settings.choose_every)
        prepare_choice(world, paper);
    const TorsionModel& model = model_of(world);
    TorsionState& state = world.write<TorsionState>();
    const AdaptiveSettings& settings = paper.settings;
    AdaptiveStatics& statics = paper.statics;
    RelaxStepReport report;
    const std::size_t evaluations = statics.memory.evaluations, renewals = statics.renewals;
    const double before = state.energy();
    report.is_finite = update_adaptive_forces(model, settings, state, statics);
    const double moved_by_hand = state.energy();
    report.hand_work = moved_by_hand - before;
    report.steps = find_steps(paper);
    // Many steps where all is at rest leave nothing of h but what rounding did not take.
    if (paper.accuracy) statics.h = std::max(statics.h, settings.step.first_h);
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
    report.active = find_active_freedom(model, statics);
    report.total = statics.selection.total;
    report.neglected = statics.selection.neglected;
    report.is_finite = report.is_finite && std::isfinite(state.energy());
    return report;
}

Vec3 find_force(const World& world, const PaperStep& paper, Entity hand) noexcept {
    if (!spring_of(world, hand)) return find_pull(world, paper, hand).tail<3>();
    return find_force_on_held(model_of(world), world.resource<TorsionState>(),
                              held_in_state(world, hand));
}

Vec6 find_pull(const World& world, const PaperStep& paper, Entity hand) noexcept {
    return find_wrench_on(paper.statics, static_cast<std::size_t>(grip_of(world, hand).base));
}

void before_step(World& world, PaperStep& paper, const StepInput& input) {
    paper.rendered.fill({});
    if (!paper.accuracy) return;
    std::vector<std::optional<LiveMolecule>> live;
    for (const HandPose& hand : input.hands) {
        live.emplace_back();
        if (hand.molecule) live.back() = {*hand.molecule, hand.grip_number};
    }
    const std::vector<Entity> hands = find_hands(world);
    for (std::size_t slot = 0; slot < input.hands.size(); ++slot) {
        const std::optional<MoleculePose>& molecule = input.hands[slot].molecule;
        if (!molecule || !world.find<Grip>(hands[slot])) continue;
        const LocalContactModel& contact = contact_of(world, hands[slot]).sent;
        paper.rendered[slot] =
            evaluate_local(contact.model, contact.field, *molecule, live).force_newton /
            units::newton_per_kcal_per_mol_angstrom;
    }
}

namespace {

// An error that is not a number is the largest.
std::optional<double> find_larger(const std::optional<double>& a, const std::optional<double>& b) {
    if (!a || (b && std::isnan(*b))) return b;
    if (!b || std::isnan(*a)) return a;
    return std::max(*a, *b);
}

// The largest error of a hand that has a tolerance, as a multiple of the smallest tolerance, which
// the controller has.
double find_error_for(const World& world, const AccuracyController& accuracy,
                      const ErrorEstimate& estimate) {
    std::optional<double> largest = 0;
    std::size_t slot = 0;
    for (const Entity hand : find_hands(world)) {
        const std::optional<double>& error_pN = estimate.last_pN[slot++];
        const auto within_pN = coupling_of(world, hand).description.feel_within_pN;
        if (error_pN && within_pN)
            largest = find_larger(largest, *error_pN * (accuracy.tolerance() / *within_pN));
    }
    return *largest;
}

}  // namespace

void after_step(World& world, PaperStep& paper) {
    std::optional<RelaxStepReport>& report = world.write<StepReport>().relaxed;
    if (!paper.estimate || !report || !report->is_finite) return;
    AccuracyController* const accuracy = paper.accuracy ? &*paper.accuracy : nullptr;
    if (accuracy) accuracy->add_step({report->active, report->steps});
    constexpr std::size_t every = 200;  // steps, where nobody asks for an accuracy
    ErrorEstimate& estimate = *paper.estimate;
    ++estimate.steps;
    if (accuracy ? !accuracy->is_due() : estimate.steps % every != 0) return;
    find_error(world, paper);
    report->is_estimating = true;
    for (const std::optional<double>& error_pN : estimate.last_pN)
        report->estimated_error_pN = find_larger(report->estimated_error_pN, error_pN);
    if (accuracy && report->estimated_error_pN)
        accuracy->add_estimate(find_error_for(world, *accuracy, estimate), estimate.felt_pN,
                               estimate.evaluations);
}

void find_error(World& world, PaperStep& paper) {
    if (!paper.estimate) return;
    ErrorEstimate& estimate = *paper.estimate;
    estimate.last_pN.fill({});
    estimate.felt_pN.fill(Vec3::Zero());
    const std::vector<Entity> hands = find_hands(world);
    const auto feels = [&](Entity hand) {
        return world.find<Grip>(hand) && is_mobile(world, hand);
    };
    if (std::ranges::none_of(hands, feels)) return;
    const TorsionModel& model = model_of(world);
    if (!estimate.memory) {
        estimate.memory = {build_lineariser(model, estimate.held), build_quasi_statics(model),
                           nullptr};
    }
    const Renewal rest =
        make_renewal(model, estimate.settings,
                     {world.resource<TorsionState>(), 0, 0, {}, {}, {}, {}}, *estimate.memory);
    if (!rest.linear) return;
    constexpr double pN = units::piconewton_per_kcal_per_mol_angstrom;
    for (std::size_t i = 0; i < hands.size(); ++i) {
        if (!feels(hands[i])) continue;
        const Vec3 felt =
            paper.rendered[i] ? *paper.rendered[i] : find_force(world, paper, hands[i]);
        const Vec3 found =
            find_force_on_held(model, rest.linear->at, held_in_state(world, hands[i]));
        estimate.last_pN[i] = pN * (felt - found).norm();
        estimate.felt_pN[i] = pN * felt;
    }
    // Second derivatives cost about as much as so many evaluations.
    constexpr std::size_t linearisation = 10;
    estimate.evaluations = rest.relaxed.evaluations + linearisation;
}

void note_time(const StepReport& report, PaperStep& paper) {
    if (!paper.budget || report.relaxed->is_estimating) return;
    if (report.relaxed->is_chosen || report.relaxed->is_renewed) {
        paper.budget->add_choice(report.took_us);
    } else {
        paper.budget->add_step(report.took_us);
    }
}

void copy_positions(World& world, PaperStep& paper) {
    const std::vector<Vec3>& moved = world.resource<TorsionState>().positions;
    std::vector<Vec3>& positions = world.write<AtomTable>().positions;
    const ModelAtoms& atoms = model_atoms_of(world);
    if (!atoms.in_table.empty()) return put_in_table(model_of(world), atoms, moved, positions);
    AdaptiveStatics& statics = paper.statics;
    if (!statics.is_built || paper.copied != statics.rebuilds) {
        positions = moved;
        paper.copied = statics.rebuilds;
    } else {
        for (std::size_t c = 0; c < statics.has_moved.size(); ++c) {
            if (statics.has_moved[c] == 0) continue;
            for (const std::uint32_t i : atoms_of(statics.clusters, c)) positions[i] = moved[i];
        }
    }
    std::ranges::fill(statics.has_moved, std::uint8_t{0});
}

}  // namespace palpa
