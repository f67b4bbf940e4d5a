#include "simulation/touch.h"

#include "core/units.h"
#include "simulation/components.h"
#include "simulation/probe.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace palpa {
namespace {

// With fewer neighbours for each atom in the hand a field is no better than its tangent.
constexpr std::size_t fewest_neighbours = 100;

const Guide& guide_of(const Simulation& simulation) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    return *simulation.world.find<Guide>(grab->molecule);
}

AtomRange grabbed_atoms(const Simulation& simulation) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    return simulation.world.find<Molecule>(grab->molecule)->atoms;
}

bool is_on_spring(const Simulation& simulation) noexcept {
    return simulation.flexible && simulation.flexible->state.tether;
}

std::size_t most_neighbours(const Simulation& simulation) noexcept {
    const std::size_t own = grabbed_points(simulation).positions.size();
    return simulation.pairs_per_tick / std::max<std::size_t>(own, 1);
}

// Numbers of the environment's atoms, nearest first.
std::vector<std::uint32_t> find_nearest(const Simulation& simulation, std::size_t count) {
    const std::span<const Vec3> own = grabbed_points(simulation).positions;
    const std::span<const Vec3> others = environment_points(simulation).positions;
    std::vector<double> distance2(others.size(), std::numeric_limits<double>::infinity());
    for (std::size_t j = 0; j < others.size(); ++j) {
        for (const Vec3& place : own)
            distance2[j] = std::min(distance2[j], (place - others[j]).squaredNorm());
    }
    std::vector<std::uint32_t> order(others.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
    const auto is_nearer = [&](std::uint32_t a, std::uint32_t b) {
        return distance2[a] < distance2[b];
    };
    if (end != order.end()) std::nth_element(order.begin(), end, order.end(), is_nearer);
    order.erase(end, order.end());
    std::ranges::sort(order);
    return order;
}

// The environment's columns for some of its atoms.
struct PickedPoints {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;
    std::vector<std::uint32_t> type;

    PickedPoints(const FieldPoints& all, std::span<const std::uint32_t> atoms) {
        for (const std::uint32_t i : atoms) {
            positions.push_back(all.positions[i]);
            charge.push_back(all.charge[i]);
            sqrt_epsilon.push_back(all.sqrt_epsilon[i]);
            half_rmin.push_back(all.half_rmin[i]);
            type.push_back(all.type[i]);
        }
    }
    FieldPoints view() const noexcept { return {positions, charge, sqrt_epsilon, half_rmin, type}; }
};

// Of the atoms nearby, or of all where they were not chosen or are too many for a servo tick.
LocalField build_local_field(const Simulation& simulation) {
    const FieldPoints group = grabbed_points(simulation), all = environment_points(simulation);
    const std::vector<std::uint32_t>& near = simulation.near.atoms;
    const bool is_whole = near.empty() || near.size() == all.positions.size();
    LocalField field;
    field.frozen =
        is_whole ? build_frozen_field(group, all, pair_rule(simulation))
                 : build_frozen_field(group, PickedPoints(all, near).view(), pair_rule(simulation));
    field.group.assign(group.positions.begin(), group.positions.end());
    field.there = evaluate_frozen_field(field.frozen, field.group);
    field.has_atoms =
        simulation.is_guarded && field.frozen.environment.positions.size() <=
                                     std::max(most_neighbours(simulation), fewest_neighbours);
    return field;
}

// What pulls at the hand, in engine units.
struct Pull {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    Mat3 stiffness = Mat3::Zero();
    double energy = 0;
};

// A hand on a spring feels the spring.
Pull find_spring_pull(const Flexible& flexible, const Tether& tether) {
    Pull pull;
    pull.force =
        tether.k * (find_tethered(flexible.model, tether, flexible.state.positions) - tether.place);
    pull.stiffness = tether.k * Mat3::Identity();
    pull.energy = flexible.state.energy();
    return pull;
}

// One that moves a molecule feels what all others do to it, with the stiffness that it would have
// if they stayed where they are.
Pull find_pull(const Simulation& simulation, const LocalField& field) {
    const Vec3 centre = field.centre;
    Pull pull;
    if (simulation.flexible) {
        // As what moves by itself feels it, with its cutoff.
        const Vec6 wrench = find_pull_on_held(*simulation.flexible);
        pull.force = wrench.tail<3>();
        pull.torque = wrench.head<3>() - centre.cross(pull.force);
        pull.stiffness = field.there.stiffness;
        pull.energy = simulation.flexible->state.energy();
        return pull;
    }
    const FieldSum sum = field_on_grabbed(simulation);
    pull.force = sum.force;
    pull.torque = sum.torque_about(centre);
    pull.stiffness = sum.stiffness;
    pull.energy = sum.energy();
    return pull;
}

TouchModel build_model(const Simulation& simulation, const HandPose& hand, const Pull& pull) {
    const Guide& guide = guide_of(simulation);
    TouchModel touch;
    touch.time_s = hand.time_s;
    touch.molecule = {guide.place, guide.orientation};
    touch.projector = guide.projector;
    touch.turns_with_handle = guide.freedom == 6;
    touch.force_newton = guide.projector * pull.force * units::newton_per_kcal_per_mol_angstrom;
    touch.torque_newton_metre = pull.torque * units::joule_per_kcal_per_mol;
    touch.stiffness_matrix_N_per_m = guide.projector * pull.stiffness * guide.projector *
                                     units::newton_per_metre_per_kcal_per_mol_angstrom2;
    touch.stiffness_N_per_m = extreme_stiffness(touch.stiffness_matrix_N_per_m);
    touch.displacement_gain =
        displacement_gain(simulation.laws.displacement, touch.force_newton.norm());
    touch.potential_kcal_per_mol = pull.energy;
    touch.active_freedom = guide.freedom;
    if (simulation.flexible)
        touch.active_freedom += static_cast<int>(find_active_freedom(*simulation.flexible));
    touch.period_s = simulation.period_s;
    touch.gives_way = simulation.flexible.has_value();
    return touch;
}

// The share of what was foretold that came, 0 to 1, or nothing where too little was.
std::optional<double> find_confirmed(const Vec3& came, const Vec3& foretold,
                                     double least) noexcept {
    const double norm2 = foretold.squaredNorm();
    if (!(norm2 > least * least)) return {};
    return std::clamp(came.dot(foretold) / norm2, 0.0, 1.0);
}

// Between the last touch and one that has its force: how much of the way the frozen field knew.
void update_confirmed(const Touch& last, Touch& touch) noexcept {
    constexpr double slowness = 0.5, least_newton = 2e-12, lever = 1e-10;
    touch.model.confirmed = last.model.confirmed;
    touch.model.confirmed_torque = last.model.confirmed_torque;
    if (!last.field.has_atoms || !touch.field.has_atoms) return;
    const FrozenSum sum = evaluate_frozen_field(last.field.frozen, touch.field.group);
    const Mat3& free = touch.model.projector;
    const Vec3 force =
        units::newton_per_kcal_per_mol_angstrom * (free * (sum.force - last.field.there.force));
    const Vec3 torque =
        units::joule_per_kcal_per_mol *
        (sum.torque_about(touch.field.centre) - last.field.there.torque_about(last.field.centre));
    if (const auto share =
            find_confirmed(touch.model.force_newton - last.model.force_newton, force, least_newton))
        touch.model.confirmed += slowness * (*share - touch.model.confirmed);
    if (const auto share =
            find_confirmed(touch.model.torque_newton_metre - last.model.torque_newton_metre, torque,
                           least_newton * lever))
        touch.model.confirmed_torque += slowness * (*share - touch.model.confirmed_torque);
}

}  // namespace

Touch build_touch(const Simulation& simulation, const HandPose& hand) noexcept {
    Touch touch;
    if (simulation.flexible && simulation.flexible->state.tether) {
        const Flexible& flexible = *simulation.flexible;
        touch.model = build_model(simulation, hand,
                                  find_spring_pull(flexible, *simulation.flexible->state.tether));
        return touch;
    }
    if (simulation.is_guarded || simulation.flexible) touch.field = build_local_field(simulation);
    touch.field.centre = centre_of_mass(simulation.atoms, grabbed_atoms(simulation));
    touch.field.pivot = grabbed_place(simulation);
    for (const Vec3& place : touch.field.group)
        touch.field.radius = std::max(touch.field.radius, (place - touch.field.pivot).norm());
    touch.model = build_model(simulation, hand, find_pull(simulation, touch.field));
    touch.model.clearance_angstrom = touch.field.there.clearance;
    return touch;
}

void update_touch(const HandPose& hand, Simulation& simulation) noexcept {
    update_near(simulation);
    Touch touch = build_touch(simulation, hand);
    touch.model.start = simulation.touch.model.start;
    update_confirmed(simulation.touch, touch);
    constexpr double stands_still = 0.95;
    if (touch.model.confirmed < stands_still) touch.model.gives_way = true;
    simulation.touch = std::move(touch);
}

void update_near(Simulation& simulation) noexcept {
    if (is_on_spring(simulation) || !(simulation.is_guarded || simulation.flexible)) return;
    constexpr double moved = 0.5;        // Å
    constexpr std::size_t rarely = 500;  // steps
    NearAtoms& near = simulation.near;
    const std::size_t most = most_neighbours(simulation);
    const Vec3& place = guide_of(simulation).place;
    const bool is_known = !near.atoms.empty() && near.steps < rarely && near.most == most &&
                          (place - near.place).norm() < moved;
    ++near.steps;
    if (is_known) return;
    near = {find_nearest(simulation,
                         most < fewest_neighbours ? std::numeric_limits<std::size_t>::max() : most),
            place, 0, most};
}

}  // namespace palpa
