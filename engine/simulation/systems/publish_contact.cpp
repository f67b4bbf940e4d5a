#include "simulation/systems/publish_contact.h"

#include "core/units.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// With fewer neighbours for each atom in the hand a field is no better than its tangent.
constexpr std::size_t fewest_neighbours = 100;

// Pairs that a servo tick has time for. Those that follow take twice the time.
std::size_t most_pairs(const World& world, Entity hand) noexcept {
    return coupling_of(world, hand).pairs_per_tick / (follows_by_model(world) ? 2 : 1);
}

// Atoms around what the hand holds that a tick has time for where every pair acts.
std::size_t most_neighbours(const World& world, Entity hand) noexcept {
    return most_pairs(world, hand) / std::max<std::size_t>(held_range(world, hand).count, 1);
}

bool has_ends(const World& world) noexcept {
    return world.resource<Interactions>().smooth.has_value();
}

// A molecule that another hand holds as a whole, which the servo moves with that hand.
struct OtherHeld {
    Entity hand;
    std::size_t slot = 0;
    AtomRange atoms;
};

std::vector<OtherHeld> list_others(const World& world, Entity hand) {
    std::vector<OtherHeld> others;
    std::size_t slot = 0;
    world.each<Hand>([&](Entity other, const Hand&) {
        const Grip* const grip = world.find<Grip>(other);
        if (grip && holds_whole(world, other) && grip->molecule != grip_of(world, hand).molecule)
            others.push_back({other, slot, held_range(world, other)});
        ++slot;
    });
    return others;
}

std::size_t count_atoms(std::span<const OtherHeld> others) noexcept {
    std::size_t count = 0;
    for (const OtherHeld& other : others) count += other.atoms.count;
    return count;
}

// All atoms of the environment that no other hand moves, rising.
std::vector<std::uint32_t> list_environment(const World& world, Entity hand,
                                            std::span<const OtherHeld> others) {
    const auto is_held = [&](std::uint32_t i) {
        return std::ranges::any_of(
            others, [&](const OtherHeld& other) { return has_atom(other.atoms, i); });
    };
    std::vector<std::uint32_t> atoms;
    for (const AtomRange& range : environment_of(world, hand)) {
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
            if (!is_held(i)) atoms.push_back(i);
        }
    }
    return atoms;
}

// The atoms nearest to what is held, in ascending order.
std::vector<std::uint32_t> find_nearest(const World& world, Entity hand, std::size_t count) {
    const std::span<const Vec3> own = held_points(world, hand).positions;
    const std::vector<Vec3>& positions = world.resource<AtomTable>().positions;
    std::vector<std::uint32_t> atoms = list_environment(world, hand, list_others(world, hand));
    std::vector<double> distance2(positions.size(), std::numeric_limits<double>::infinity());
    for (const std::uint32_t j : atoms) {
        for (const Vec3& place : own)
            distance2[j] = std::min(distance2[j], (place - positions[j]).squaredNorm());
    }
    const auto end = atoms.begin() + static_cast<std::ptrdiff_t>(std::min(count, atoms.size()));
    const auto is_nearer = [&](std::uint32_t a, std::uint32_t b) {
        return distance2[a] < distance2[b];
    };
    if (end != atoms.end()) std::nth_element(atoms.begin(), end, atoms.end(), is_nearer);
    atoms.erase(end, atoms.end());
    std::ranges::sort(atoms);
    return atoms;
}

// With smooth ends a tick looks only at pairs in reach: the atoms that are in reach or nearly so,
// the nearest first, as far as there is time for their pairs; in an order of neighbours.
std::vector<std::uint32_t> find_in_reach(const World& world, Entity hand) {
    constexpr double margin = 2;        // Å, gone before the next choice
    constexpr std::size_t fewest = 16;  // however far
    struct Near {
        double distance2;
        std::uint32_t atom;
        std::size_t pairs;
    };
    const std::span<const Vec3> own = held_points(world, hand).positions;
    const AtomTable& table = world.resource<AtomTable>();
    const double reach = world.resource<Interactions>().smooth->reach() + margin;
    std::vector<Near> near;
    for (const std::uint32_t j : list_environment(world, hand, list_others(world, hand))) {
        Near& added = near.emplace_back(std::numeric_limits<double>::infinity(), j, 0);
        for (const Vec3& place : own) {
            const double distance2 = (place - table.positions[j]).squaredNorm();
            added.distance2 = std::min(added.distance2, distance2);
            if (distance2 < reach * reach) ++added.pairs;
        }
    }
    std::ranges::sort(near, {}, [](const Near& a) { return std::pair(a.distance2, a.atom); });
    std::vector<std::uint32_t> atoms;
    std::vector<Vec3> places;
    std::vector<std::uint8_t> has_solvation;
    std::size_t pairs = 0;
    for (const Near& next : near) {
        pairs += next.pairs;
        if (atoms.size() >= fewest && (next.pairs == 0 || pairs > most_pairs(world, hand))) break;
        atoms.push_back(next.atom);
        places.push_back(table.positions[next.atom]);
        has_solvation.push_back(table.solvation.volume[next.atom] != 0 ||
                                table.solvation.strength[next.atom] != 0);
    }
    std::vector<std::uint32_t> order = order_for_sixteens(places, has_solvation);
    for (std::uint32_t& place : order) place = atoms[place];
    return order;
}

// The atoms nearby, or all where they were not chosen or are too many for a servo tick.
std::vector<std::uint32_t> list_field_atoms(const World& world, Entity hand,
                                            std::span<const OtherHeld> others) {
    const std::vector<std::uint32_t>& near = contact_of(world, hand).near.atoms;
    return near.empty() ? list_environment(world, hand, others) : near;
}

FrozenField freeze(const World& world, Entity hand, const FieldPoints& group,
                   std::span<const OtherHeld> others) {
    const AtomTable& atoms = world.resource<AtomTable>();
    const std::vector<std::uint32_t>& near = contact_of(world, hand).near.atoms;
    const std::vector<AtomRange> all = environment_of(world, hand);
    const std::size_t still = count_environment(world, hand) - count_atoms(others);
    const bool is_whole = near.empty() || (near.size() == still && !has_ends(world));
    if (is_whole && all.size() == 1 && others.empty())
        return build_frozen_field(group, points_of(atoms, all.front()), pair_rule(world));
    const GatheredPoints points(atoms, list_field_atoms(world, hand, others));
    return build_frozen_field(group, points.view(), pair_rule(world));
}

HeldField build_held_field(const World& world, Entity hand, const OtherHeld& other,
                           const FieldPoints& group) {
    HeldField held;
    held.hand = other.slot;
    held.then = {grip_of(world, other.hand).pose,
                 contact_of(world, other.hand).sent.model.grip_number};
    held.pivot = held_place(world, other.hand);
    held.frozen = build_frozen_field(group, points_of(world.resource<AtomTable>(), other.atoms),
                                     pair_rule(world));
    held.at_step = evaluate_frozen_field(held.frozen, group.positions);
    held.relaxed_N_per_m = find_relaxed_coupling(world, hand, other.hand);
    return held;
}

LocalField build_local_field(const World& world, Entity hand) {
    const FieldPoints group = held_points(world, hand);
    LocalField field;
    const std::vector<OtherHeld> others = list_others(world, hand);
    field.frozen = freeze(world, hand, group, others);
    field.group.assign(group.positions.begin(), group.positions.end());
    field.at_step = evaluate_frozen_field(field.frozen, field.group);
    for (const OtherHeld& other : others)
        field.held.push_back(build_held_field(world, hand, other, group));
    field.has_atoms =
        coupling_of(world, hand).is_guarded &&
        (has_ends(world) || field.frozen.environment.positions.size() + count_atoms(others) <=
                                std::max(most_neighbours(world, hand), fewest_neighbours));
    if (field.has_atoms)
        field.following = find_following(world, hand, field, list_field_atoms(world, hand, others));
    return field;
}

// The pull at the hand, in engine units.
struct Pull {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    Mat3 stiffness = Mat3::Zero();
    double energy = 0;
};

// A hand on a spring feels the spring.
Pull find_pull_of(const World& world, const ModelSpring& spring) {
    const TorsionState& state = world.resource<TorsionState>();
    Pull pull;
    pull.force = find_spring_force(model_of(world), spring, state.positions);
    pull.stiffness = find_spring_stiffness(model_of(world), spring, state.positions);
    pull.energy = find_energy(world);
    return pull;
}

// At a remote engine's atoms that of its low-passed middle; nothing while no frames come.
Pull find_engine_pull(const World& world, Entity hand) {
    Pull pull;
    pull.energy = find_engine_energy(world);
    const EngineSpring spring = find_engine_spring(world, hand);
    pull.force = spring.force;
    pull.stiffness = spring.stiffness;
    return pull;
}

// One that moves a molecule feels what all others do to it, with the stiffness that it would have
// if they stayed where they are.
Pull find_pull(const World& world, Entity hand, const LocalField& field) {
    const Vec3 centre = field.centre;
    Pull pull;
    if (grip_of(world, hand).base >= 0) {
        // Takes the pull from the mechanics, with their cutoff.
        const Vec6 wrench = find_pull_on_held(world, hand);
        pull.force = wrench.tail<3>();
        pull.torque = wrench.head<3>() - centre.cross(pull.force);
        pull.stiffness = sum_at_step(field).stiffness;
        pull.energy = find_energy(world);
        return pull;
    }
    const FieldSum sum = fast_field_on_held(world, hand);
    pull.force = sum.force;
    pull.torque = sum.torque_about(centre);
    pull.stiffness = sum.stiffness;
    pull.energy = sum.energy();
    return pull;
}

ContactModel build_model(const World& world, Entity hand, const HandPose& pose, const Pull& pull) {
    const Grip& grip = grip_of(world, hand);
    ContactModel contact;
    contact.time_s = pose.time_s;
    contact.molecule = grip.pose;
    contact.projector = grip.projector;
    contact.turns_with_handle = grip.freedom == 6;
    contact.force_newton = grip.projector * pull.force * units::newton_per_kcal_per_mol_angstrom;
    contact.torque_newton_metre = pull.torque * units::joule_per_kcal_per_mol;
    contact.stiffness_matrix_N_per_m = grip.projector * pull.stiffness * grip.projector *
                                       units::newton_per_metre_per_kcal_per_mol_angstrom2;
    contact.stiffness_N_per_m = extreme_stiffness(contact.stiffness_matrix_N_per_m);
    contact.displacement_gain =
        displacement_gain(coupling_of(world, hand).laws.displacement, contact.force_newton.norm());
    contact.potential_kcal_per_mol = pull.energy;
    contact.active_freedom = grip.freedom + static_cast<int>(find_active_freedom(world));
    contact.period_s = world.resource<Clock>().period_s;
    contact.is_compliant = has_mobile(world);
    if (const std::optional<double> error_pN = find_error_estimate(world, hand))
        contact.error_estimate_newton = 1e-12 * *error_pN;
    if (const auto& relaxed = world.resource<StepReport>().relaxed; relaxed && relaxed->model_age)
        contact.model_age_angstrom = *relaxed->model_age;
    contact.relaxed = find_relaxed_stiffness(world, hand);
    return contact;
}

// Whether the servo, or the stiffness, needs the atoms around what is held.
bool needs_field(const World& world, Entity hand) noexcept {
    return holds_whole(world, hand) &&
           (coupling_of(world, hand).is_guarded || grip_of(world, hand).base >= 0);
}

// The share of what was foretold that came, 0 to 1, or nothing where too little was.
std::optional<double> find_confirmed(const Vec3& came, const Vec3& foretold,
                                     double least) noexcept {
    const double norm2 = foretold.squaredNorm();
    if (!(norm2 > least * least)) return {};
    return std::clamp(came.dot(foretold) / norm2, 0.0, 1.0);
}

// The molecules of other hands that a field has, by slot.
std::vector<std::optional<LiveMolecule>> list_held(const LocalField& field) {
    std::vector<std::optional<LiveMolecule>> held;
    for (const HeldField& other : field.held) {
        held.resize(std::max(held.size(), other.hand + 1));
        held[other.hand] = other.then;
    }
    return held;
}

// Between the last contact model and one that has its force: how much of the way the field knew,
// what other hands hold included.
void update_confirmed(const LocalContactModel& last, LocalContactModel& contact) {
    constexpr double slowness = 0.5, least_newton = 2e-12, lever = 1e-10;
    contact.model.prediction_gain = last.model.prediction_gain;
    contact.model.torque_prediction_gain = last.model.torque_prediction_gain;
    if (!last.field.has_atoms || !contact.field.has_atoms || contact.model.relaxed) return;
    const FrozenSum sum =
        evaluate_field(last.field, contact.field.group, {}, list_held(contact.field));
    const FrozenSum before = sum_at_step(last.field);
    const Mat3& free = contact.model.projector;
    const Vec3 force =
        units::newton_per_kcal_per_mol_angstrom * (free * (sum.force - before.force));
    const Vec3 torque = units::joule_per_kcal_per_mol * (sum.torque_about(contact.field.centre) -
                                                         before.torque_about(last.field.centre));
    if (const auto share = find_confirmed(contact.model.force_newton - last.model.force_newton,
                                          force, least_newton))
        contact.model.prediction_gain += slowness * (*share - contact.model.prediction_gain);
    if (const auto share =
            find_confirmed(contact.model.torque_newton_metre - last.model.torque_newton_metre,
                           torque, least_newton * lever))
        contact.model.torque_prediction_gain +=
            slowness * (*share - contact.model.torque_prediction_gain);
}

}  // namespace

void publish_contact(World& world, const StepInput& input) {
    const StepReport& report = world.resource<StepReport>();
    std::size_t slot = 0;
    world.each<Hand>([&](Entity hand, const Hand&) {
        if (world.find<Grip>(hand)) {
            update_contact(world, hand, slot < input.hands.size() ? input.hands[slot] : HandPose{});
            const std::optional<double>& gain = report.moves[slot].displacement_gain;
            if (gain) world.write<Contact>(hand)->sent.model.displacement_gain = *gain;
        }
        ++slot;
    });
}

void update_contact(World& world, Entity hand, const HandPose& pose) {
    update_near(world, hand);
    LocalContactModel contact = build_local_contact(world, hand, pose);
    LocalContactModel& last = world.write<Contact>(hand)->sent;
    contact.model.grip_number = last.model.grip_number;
    if (last.model.relaxed && contact.model.relaxed)
        limit_change(*last.model.relaxed, contact.model.period_s, *contact.model.relaxed);
    update_confirmed(last, contact);
    constexpr double stands_still = 0.95;
    if (contact.model.prediction_gain < stands_still) contact.model.is_compliant = true;
    last = std::move(contact);
}

void renew_contact(World& world, Entity hand) {
    const bool holds = world.find<Grip>(hand);
    if (holds) update_near(world, hand);
    LocalContactModel contact =
        holds ? build_local_contact(world, hand, {}) : build_still_contact(world);
    LocalContactModel& last = world.write<Contact>(hand)->sent;
    contact.model.grip_number = last.model.grip_number;
    last = std::move(contact);
}

LocalContactModel build_still_contact(const World& world) {
    LocalContactModel contact;
    contact.model.is_still = true;
    contact.model.period_s = world.resource<Clock>().period_s;
    return contact;
}

LocalContactModel build_local_contact(const World& world, Entity hand, const HandPose& pose) {
    LocalContactModel contact;
    if (const EngineHold* const hold = world.find<EngineHold>(hand)) {
        contact.model = build_model(world, hand, pose, find_engine_pull(world, hand));
        contact.model.is_compliant = true;
        contact.model.is_still = !hold->is_live;
        return contact;
    }
    if (const ModelSpring* const spring = spring_of(world, hand)) {
        contact.model = build_model(world, hand, pose, find_pull_of(world, *spring));
        return contact;
    }
    if (needs_field(world, hand)) contact.field = build_local_field(world, hand);
    contact.field.centre = centre_of_mass(world.resource<AtomTable>(), held_range(world, hand));
    contact.field.pivot = held_place(world, hand);
    for (const Vec3& place : contact.field.group)
        contact.field.radius = std::max(contact.field.radius, (place - contact.field.pivot).norm());
    contact.model = build_model(world, hand, pose, find_pull(world, hand, contact.field));
    contact.model.clearance_angstrom = sum_at_step(contact.field).clearance;
    return contact;
}

void update_near(World& world, Entity hand) {
    const Grip& grip = grip_of(world, hand);
    if (!needs_field(world, hand)) return;
    constexpr double moved = 0.5;        // Å
    constexpr std::size_t rarely = 500;  // steps
    NearAtoms& near = world.write<Contact>(hand)->near;
    const std::size_t all = most_neighbours(world, hand);
    const std::size_t most = all - std::min(all, count_atoms(list_others(world, hand)));
    const Vec3& place = grip.pose.place_angstrom;
    const bool is_known = !near.atoms.empty() && near.steps < rarely && near.most == most &&
                          (place - near.place).norm() < moved;
    ++near.steps;
    if (is_known) return;
    if (has_ends(world)) {
        near = {find_in_reach(world, hand), place, 0, most};
        return;
    }
    near = {find_nearest(world, hand,
                         most < fewest_neighbours ? std::numeric_limits<std::size_t>::max() : most),
            place, 0, most};
}

}  // namespace palpa
