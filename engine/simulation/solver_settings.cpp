#include "simulation/solver_settings.h"

#include "core/load_error.h"
#include "core/units.h"
#include "simulation/coupling.h"
#include "simulation/held.h"
#include "simulation/solvent.h"
#include "simulation/systems/gather_springs.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
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

// Lists the mobile parts that hands hold, in their order.
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

}  // namespace

RelaxSettings build_settings(const World& world) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    const ForceFieldDescription& force_field = world.resource<ForceFieldInUse>().description;
    RelaxSettings settings;
    settings.method = method_of(s);
    settings.force_tolerance = s.rest_kcal_per_mol;
    settings.steps = static_cast<std::size_t>(s.steps);
    settings.largest_move = s.largest_move_angstrom;
    settings.keeps_pairs = true;  // from period to period
    settings.step.largest_move = s.largest_move_angstrom;
    ForceSettings& forces = settings.step.forces;
    forces.fast = s.pairs == PairPrecision::Fast;
    forces.nonbonded.coulomb_constant = force_field.coulomb_constant;
    if (force_field.solvent != Solvent::None) {
        forces.nonbonded = solvent_settings(force_field);
    } else if (s.cutoff_angstrom) {
        constexpr double width = 2;  // Å
        forces.nonbonded.electrostatics = ElectrostaticCutoff::ForceSwitch;
        forces.nonbonded.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
        forces.nonbonded.cutoff = *s.cutoff_angstrom;
        forces.nonbonded.switch_from = *s.cutoff_angstrom - width;
    }
    return settings;
}

RelaxMethod find_method(const World& world, Eigen::Index coordinates) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    const RelaxMethod method = method_of(s);
    if (method != RelaxMethod::SecondOrder || coordinates <= most_second_order_coordinates)
        return method;
    if (!s.method) return RelaxMethod::QuasiStatic;
    throw LoadError(
        world.resource<ScenePlaces>().place_of("statics.method"),
        fmt::format("the second-order method with {} degrees of freedom would need {:.1f} GB and "
                    "minutes; expected at most {} degrees of freedom: use fewer joints "
                    "(joints.region_angstrom, joints.within_angstrom), or quasi-static",
                    coordinates, 5e-8 * static_cast<double>(coordinates * coordinates),
                    most_second_order_coordinates));
}

AdaptiveState build_adaptive(const RelaxSettings& settings, const TorsionModel& model,
                             std::span<const HeldPart> held, const World& world) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    AdaptiveState adaptive;
    adaptive.settings = build_adaptive_settings(s, settings.step);
    adaptive.statics = build_adaptive_statics(model);
    adaptive.weighs_hand_proximity = s.weights == JointWeights::HandProximity;
    if (adaptive.weighs_hand_proximity) {
        adaptive.mobility_weights = find_mobility_weights(model);
        // The part in the hand weighs nothing.
        for (const HeldPart& part : held)
            adaptive.mobility_weights[model.tree.bases[part.base]] = 1;
        adaptive.settings.factors = adaptive.mobility_weights;
    }
    adaptive.choose_every = adaptive.settings.choose_every;
    if (s.budget_us) adaptive.budget.emplace(*s.budget_us);
    if (const auto within_pN = world.resource<Coupling>().description.feel_within_pN) {
        adaptive.accuracy.emplace(
            *within_pN, WorkBudget{adaptive.settings.limits.degrees_of_freedom, settings.steps},
            static_cast<std::size_t>(model.coordinates), adaptive.budget.has_value());
    }
    return adaptive;
}

SecondOrder build_second_order(const StaticsDescription& s, const RelaxSettings& settings,
                               const World& world) {
    SecondOrder second;
    second.settings.forces = settings.step.forces;
    second.settings.near_reach = s.near_angstrom;
    second.settings.renew_hand = s.renew_angstrom;
    if (s.responses > 0) second.settings.responses = static_cast<std::size_t>(s.responses);
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

ErrorEstimate build_error_estimate(const RelaxSettings& settings, Solvent solvent,
                                   const World& world) {
    ErrorEstimate estimate;
    ForceSettings& forces = estimate.settings.forces = settings.step.forces;
    if (solvent == Solvent::None) {
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

}  // namespace palpa
