#include "statics/torsion_state.h"

#include "core/assertion.h"

#include <algorithm>
#include <utility>

namespace palpa {
namespace {

std::span<const Body> bodies_of(const TorsionModel& model) { return model.tree.bodies.bodies; }

RigidMotion motion_of_base(const TorsionState& state, std::size_t molecule) {
    return {state.turns[molecule].toRotationMatrix(), state.shifts[molecule]};
}

void rotate_base(std::size_t molecule, const Eigen::Quaterniond& rotation, const Vec3& pivot,
                 TorsionState& state) {
    state.turns[molecule] = (rotation * state.turns[molecule]).normalized();
    state.shifts[molecule] = pivot + rotation * (state.shifts[molecule] - pivot);
}

// Turns a base about its pivot (rad, along the axis of `turn`), then displaces it.
void move_base(std::size_t molecule, const Vec3& turn, const Vec3& by, TorsionState& state) {
    if (turn.norm() > 0) rotate_base(molecule, turn_of(turn), state.pivots[molecule], state);
    state.shifts[molecule] += by;
}

// Of molecules for which `is_wanted`.
template <typename F>
void update_pivots_where(const TorsionModel& model, TorsionState& state, F&& is_wanted) noexcept {
    std::vector<Vec3>& pivots = state.pivots;
    const auto is_summed = [&](std::uint32_t m) {
        return model.bases[m].freedom == BaseFreedom::Free && is_wanted(m);
    };
    for (std::uint32_t m = 0; m < pivots.size(); ++m) {
        if (is_summed(m)) pivots[m].setZero();
    }
    for (const std::uint32_t i : model.mobile_atoms) {
        const std::uint32_t m = model.tree.molecule_of[model.tree.bodies.body_of[i]];
        if (is_summed(m)) pivots[m] += model.masses[i] * state.positions[i];
    }
    for (std::uint32_t m = 0; m < pivots.size(); ++m) {
        if (!is_wanted(m)) continue;
        pivots[m] = is_summed(m) ? Vec3(pivots[m] / model.molecule_masses[m])
                                 : state.positions[model.bases[m].pivot];
    }
}

template <typename F>
void update_where(const TorsionModel& model, TorsionState& state, F&& is_wanted) noexcept {
    const std::span<const Body> bodies = bodies_of(model);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const std::uint32_t molecule = model.tree.molecule_of[b];
        if (!is_wanted(molecule)) continue;
        if (model.tree.bodies.is_base(b)) {
            state.motions[b] = motion_of_base(state, molecule);
            continue;
        }
        const RigidMotion& parent = state.motions[bodies[b].parent];
        state.motions[b] = state.angles[b] == 0
                               ? parent
                               : parent * turn_about(model.reference[bodies[b].axis[1]],
                                                     model.axes[b], state.angles[b]);
    }
    for (const std::uint32_t i : model.mobile_atoms) {
        const std::uint32_t body = model.tree.bodies.body_of[i];
        if (is_wanted(model.tree.molecule_of[body]))
            state.positions[i] = state.motions[body] * model.reference[i];
    }
    update_pivots_where(model, state, is_wanted);
}

}  // namespace

std::size_t TorsionState::count_bytes() const noexcept {
    const auto bytes_of = [](const auto&... vectors) {
        return ((vectors.size() * sizeof(vectors[0])) + ...);
    };
    return bytes_of(angles, turns, shifts, motions, positions, forces, wrenches);
}

TorsionState build_torsion_state(const TorsionModel& model) {
    const std::size_t bodies = bodies_of(model).size(), molecules = model.bases.size();
    TorsionState state;
    state.angles.assign(bodies, 0);
    state.turns.assign(molecules, Eigen::Quaterniond::Identity());
    state.shifts.assign(molecules, Vec3::Zero());
    state.motions.assign(bodies, {});
    state.positions = model.reference;
    state.pivots.assign(molecules, Vec3::Zero());
    state.forces.assign(model.reference.size(), Vec3::Zero());
    state.wrenches.assign(bodies, Vec6::Zero());
    state.coordinate_forces = Coordinates::Zero(model.coordinates);
    update_positions(model, state);
    return state;
}

void update_positions(const TorsionModel& model, TorsionState& state) noexcept {
    update_where(model, state, [](std::uint32_t) { return true; });
}

void update_positions(const TorsionModel& model, std::span<const std::uint8_t> is_changed,
                      TorsionState& state) noexcept {
    update_where(model, state, [&](std::uint32_t molecule) { return is_changed[molecule] != 0; });
}

void update_pivots(const TorsionModel& model, TorsionState& state) noexcept {
    update_pivots_where(model, state, [](std::uint32_t) { return true; });
}

bool is_fast(const ForceSettings& settings) noexcept {
    return settings.fast && has_fast_form(settings.nonbonded);
}

EnergyTerms add_model_forces(const TorsionModel& model, const ForceSettings& settings,
                             ForceMemory& memory, std::span<const Vec3> positions,
                             std::span<Vec3> forces) {
    const Topology& topology = model.topology;
    if (settings.fast) {
        return add_fast_forces(topology, model.fast, settings.nonbonded, settings.skin, positions,
                               memory.fast_pairs, forces, PairResult::ForcesAndEnergies,
                               settings.threads);
    }
    if (!has_end(settings.nonbonded))
        return add_forces(topology, settings.nonbonded, positions, forces);
    if (memory.list.positions.empty() || is_outdated(memory.list, positions)) {
        memory.list = build_pair_list(topology.exclusions, find_reach(settings.nonbonded),
                                      settings.skin, positions, {}, std::move(memory.list));
    }
    return add_forces(topology, settings.nonbonded, memory.list, positions, forces,
                      settings.threads);
}

void update_forces(const TorsionModel& model, const ForceSettings& settings, ForceMemory& memory,
                   TorsionState& state) {
    std::ranges::fill(state.forces, Vec3::Zero());
    state.terms = add_model_forces(model, settings, memory, state.positions, state.forces);
    state.spring_energy = 0;
    for (const ModelSpring& spring : state.springs) {
        state.spring_energy += add_spring_forces(model, spring, state.positions, state.forces);
    }
    ++memory.evaluations;
}

void update_coordinate_forces(const TorsionModel& model, TorsionState& state) noexcept {
    const std::span<const Body> bodies = bodies_of(model);
    std::ranges::fill(state.wrenches, Vec6::Zero());
    for (const std::uint32_t i : model.mobile_atoms) {
        Vec6& wrench = state.wrenches[model.tree.bodies.body_of[i]];
        wrench.head<3>() += state.positions[i].cross(state.forces[i]);
        wrench.tail<3>() += state.forces[i];
    }
    const auto torque_about = [](const Vec6& wrench, const Vec3& point) -> Vec3 {
        return wrench.head<3>() - point.cross(wrench.tail<3>());
    };
    for (std::size_t b = bodies.size(); b-- > 0;) {
        const Vec6& wrench = state.wrenches[b];
        if (model.tree.bodies.is_base(b)) {
            const std::uint32_t molecule = model.tree.molecule_of[b];
            const Eigen::Index first = model.coordinate_of_base[molecule];
            if (first < 0) continue;
            state.coordinate_forces.segment<3>(first) =
                torque_about(wrench, state.pivots[molecule]);
            if (model.bases[molecule].freedom == BaseFreedom::Free)
                state.coordinate_forces.segment<3>(first + 3) = wrench.tail<3>();
            continue;
        }
        const auto [j, k] = bodies[b].axis;
        const Vec3 axis = (state.positions[k] - state.positions[j]).normalized();
        state.coordinate_forces[model.coordinate_of_body[b]] =
            axis.dot(torque_about(wrench, state.positions[k]));
        state.wrenches[bodies[b].parent] += wrench;
    }
}

void add_move(const TorsionModel& model, const Coordinates& move, TorsionState& state) noexcept {
    PALPA_ASSERT(move.size() == model.coordinates);
    for (std::size_t b = 0; b < state.angles.size(); ++b) {
        if (model.coordinate_of_body[b] >= 0) state.angles[b] += move[model.coordinate_of_body[b]];
    }
    for (std::size_t m = 0; m < state.turns.size(); ++m) {
        const Eigen::Index first = model.coordinate_of_base[m];
        if (first < 0) continue;
        const bool is_free = model.bases[m].freedom == BaseFreedom::Free;
        move_base(m, move.segment<3>(first),
                  is_free ? Vec3(move.segment<3>(first + 3)) : Vec3::Zero(), state);
    }
    update_positions(model, state);
}

void shift_base(const TorsionModel& model, std::size_t molecule, const Vec3& by,
                TorsionState& state) noexcept {
    state.shifts[molecule] += by;
    update_where(model, state, [=](std::uint32_t m) { return m == molecule; });
}

void turn_base(const TorsionModel& model, std::size_t molecule, const Eigen::Quaterniond& turn,
               const Vec3& by, TorsionState& state) noexcept {
    rotate_base(molecule, turn, state.pivots[molecule], state);
    state.shifts[molecule] += by;
    update_where(model, state, [=](std::uint32_t m) { return m == molecule; });
}

Vec6 find_wrench_on(const TorsionModel& model, const TorsionState& state,
                    std::size_t molecule) noexcept {
    Vec6 wrench = Vec6::Zero();
    for (std::size_t i = 0; i < state.forces.size(); ++i) {
        if (model.tree.molecule_of[model.tree.bodies.body_of[i]] != molecule) continue;
        wrench.head<3>() += state.positions[i].cross(state.forces[i]);
        wrench.tail<3>() += state.forces[i];
    }
    return wrench;
}

void copy_coordinates(const TorsionState& from, TorsionState& to) noexcept {
    to.angles = from.angles;
    to.turns = from.turns;
    to.shifts = from.shifts;
    to.springs = from.springs;
    to.motions = from.motions;
    to.positions = from.positions;
    to.pivots = from.pivots;
}

void swap_coordinates(TorsionState& a, TorsionState& b) noexcept {
    a.angles.swap(b.angles);
    a.turns.swap(b.turns);
    a.shifts.swap(b.shifts);
    a.springs.swap(b.springs);
    a.motions.swap(b.motions);
    a.positions.swap(b.positions);
    a.pivots.swap(b.pivots);
}

void take_over(TorsionState& from, TorsionState& to) noexcept {
    copy_coordinates(from, to);
    to.terms = from.terms;
    to.spring_energy = from.spring_energy;
    std::swap(to.forces, from.forces);
    std::swap(to.coordinate_forces, from.coordinate_forces);
}

Vec3 find_force_on_held(const TorsionModel& model, const TorsionState& state,
                        const HeldInState& held) noexcept {
    if (held.spring >= 0) {
        const ModelSpring& spring = state.springs[static_cast<std::size_t>(held.spring)];
        return find_spring_force(model, spring, state.positions);
    }
    return find_wrench_on(model, state, held.base).tail<3>();
}

}  // namespace palpa
