#include "statics/adaptive_step.h"

#include "core/assertion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpa {
namespace {

bool is_base(const AdaptiveStatics& statics, std::size_t cluster) {
    return statics.clusters.tree.bodies.is_base(cluster);
}

bool may_base_move(const TorsionModel& model, const AdaptiveStatics& statics,
                   std::size_t molecule) {
    return model.coordinate_of_base[molecule] >= 0 &&
           statics.moving.passes.is_active[statics.clusters.tree.bases[molecule]] != 0;
}

double find_rms(const std::vector<Vec3>& forces) {
    double squares = 0;
    for (const Vec3& force : forces) squares += force.squaredNorm();
    return std::sqrt(squares / static_cast<double>(forces.size()));
}

// ---- forces ----------------------------------------------------------------------------------

// Of atoms that have moved last.
bool are_near(const AdaptiveStatics& statics, const TorsionState& state,
              const std::vector<Vec3>& places, double most) {
    for (std::size_t c = 0; c < statics.clusters.clusters.size(); ++c) {
        if (statics.is_moved[c] == 0) continue;
        for (const std::uint32_t i : atoms_of(statics.clusters, c)) {
            if (!((state.positions[i] - places[i]).norm() <= most)) return false;
        }
    }
    return true;
}

// The same of where the list of solvation has them.
bool is_solvation_near(const TorsionModel& model, const AdaptiveStatics& statics,
                       const TorsionState& state, double most) {
    const FastSolvationPairs& pairs = statics.memory.fast_pairs.solvation;
    if (pairs.builds == 0) return true;
    const std::vector<std::uint32_t>& atoms = model.fast.atoms.solvation.atoms;
    for (std::size_t k = 0; k < atoms.size(); ++k) {
        if (statics.is_moved[statics.cluster_of[atoms[k]]] == 0) continue;
        if (!((state.positions[atoms[k]] - pairs.list.positions[k]).norm() <= most)) return false;
    }
    return true;
}

bool is_list_outdated(const TorsionModel& model, const AdaptiveSettings& settings,
                      const TorsionState& state, const AdaptiveStatics& statics) {
    const ForceSettings& forces = settings.step.forces;
    if (!has_end(forces.nonbonded) || statics.is_whole) return false;
    const std::vector<Vec3>& listed =
        forces.fast ? statics.memory.fast_pairs.list.positions : statics.memory.list.positions;
    // A step must not leave the list's reach.
    const double most = 0.5 * forces.skin - settings.step.largest_move;
    return !are_near(statics, state, listed, most) ||
           !is_solvation_near(model, statics, state, most);
}

// Whether pairs between clusters may be missing after a move by `room`, Å.
bool are_tiles_outdated(const AdaptiveSettings& settings, const TorsionState& state,
                        const AdaptiveStatics& statics, double room) {
    const ForceSettings& forces = settings.step.forces;
    return is_fast(forces) && has_end(forces.nonbonded) && !statics.is_whole &&
           !are_near(statics, state, statics.clustered, 0.5 * statics.tile_skin - room);
}

// The springs' part of the forces, where they are wanted on atoms. Returns their energy.
template <class Visit>
double visit_spring_forces(const TorsionModel& model, const TorsionState& state,
                           const Visit& visit) {
    double energy = 0;
    for (const ModelSpring& spring : state.springs) {
        const SpringPull pull = find_spring_pull(model, spring, state.positions);
        const Vec3 force = -pull.k * pull.stretch;
        visit_pulled(model, spring,
                     [&](std::uint32_t atom, double share) { visit(atom, share * force); });
        energy += pull.energy;
    }
    return energy;
}

// Forces between clusters into `forces`, the wrenches that they and the springs are, and the
// energy.
void update_across(const TorsionModel& model, const AdaptiveSettings& settings, TorsionState& state,
                   AdaptiveStatics& statics, std::vector<Vec3>& forces) {
    for (const std::uint32_t i : statics.pulled) forces[i].setZero();
    const ForceSettings& f = settings.step.forces;
    if (statics.is_whole) {
        statics.across_terms = add_model_forces(model, f, statics.memory, state.positions, forces);
    } else {
        statics.across_terms =
            add_group_forces(model.topology, f.nonbonded, statics.across, state.positions, forces);
        if (statics.across.was_in_double) ++statics.memory.fast_pairs.in_double;
    }
    ++statics.memory.evaluations;
    state.terms = statics.within_terms;
    state.terms += statics.across_terms;

    std::vector<BodyState>& bodies = statics.moving.passes.bodies;
    for (std::size_t c = 0; c < bodies.size(); ++c) {
        bodies[c].centre = statics.moving.centres[c];
        bodies[c].force.setZero();
        bodies[c].torque.setZero();
    }
    const auto add = [&](std::uint32_t atom, const Vec3& force) {
        BodyState& body = bodies[statics.cluster_of[atom]];
        body.force += force;
        body.torque += (state.positions[atom] - body.centre).cross(force);
    };
    for (const std::uint32_t i : statics.pulled) add(i, forces[i]);
    state.spring_energy = visit_spring_forces(model, state, add);
}

// A number for each atom: its cluster, and one for all that cannot move at all, since they are at
// rest against each other.
std::vector<std::uint32_t> find_groups(const TorsionModel& model, const AdaptiveStatics& statics) {
    const AssemblyTree& tree = statics.clusters.tree;
    std::vector<std::uint32_t> group_of;
    for (std::uint32_t c = 0; c < statics.clusters.clusters.size(); ++c) group_of.push_back(c);
    for (std::size_t m = 0; m < tree.bases.size(); ++m) {
        if (statics.is_guided[m] == 0 && !may_base_move(model, statics, m))
            group_of[tree.bases[m]] = no_body;
    }
    std::vector<std::uint32_t> groups;
    for (const std::uint32_t cluster : statics.cluster_of) groups.push_back(group_of[cluster]);
    return groups;
}

// By hand, of any molecule that is in one, Å.
double find_hand_shift(const AdaptiveStatics& statics) {
    double largest = 0;
    for (std::size_t m = 0; m < statics.shifts.size(); ++m) {
        if (statics.is_guided[m] != 0) largest = std::max(largest, statics.shifts[m]);
    }
    return largest;
}

// All that there is, so that no choice can be another one.
bool is_everything_chosen(const TorsionModel& model, const SelectionLimits& limits,
                          const AdaptiveStatics& statics) {
    const auto all = static_cast<std::size_t>(model.coordinates);
    return statics.choices > 0 && statics.selection.degrees_of_freedom == all &&
           limits.degrees_of_freedom >= all && limits.neglected <= 0;
}

void build_clusters(const TorsionModel& model, const TorsionState& state,
                    AdaptiveStatics& statics) {
    const std::vector<std::uint8_t>& is_active = statics.selection.is_active;
    statics.clusters = build_hybrid_tree(model.tree, is_active, state.positions);
    statics.moving = build_hybrid_state(statics.clusters, is_active, statics.whole.guides);
    statics.cluster_of = statics.clusters.tree.bodies.body_of;
    statics.is_moved.assign(statics.clusters.clusters.size(), 0);
    statics.has_moved.assign(statics.clusters.clusters.size(), 0);
    statics.turns.assign(statics.clusters.clusters.size(), 0);
    statics.base_moves.assign(model.bases.size(), Vec6::Zero());
    ++statics.rebuilds;
}

// What acts between the clusters.
void build_across(const TorsionModel& model, const AdaptiveSettings& settings,
                  const TorsionState& state, AdaptiveStatics& statics) {
    const ForceSettings& forces = settings.step.forces;
    // What is taken out of a list would be out of date before the list is, and would leave out
    // nothing.
    const bool has_list = has_end(forces.nonbonded) || !is_fast(forces);
    statics.is_whole = has_list && is_everything_chosen(model, settings.limits, statics);
    if (statics.is_whole) {
        statics.across = {};
        statics.pulled.resize(model.masses.size());
        std::iota(statics.pulled.begin(), statics.pulled.end(), 0);
        return;
    }
    const std::vector<std::uint32_t> groups = find_groups(model, statics);
    // A hand that goes fast has room for a few of its moves.
    statics.tile_skin = std::min(forces.skin, settings.tile_skin + 2 * settings.step.largest_move +
                                                  4 * find_hand_shift(statics));
    statics.clustered = state.positions;
    statics.across =
        is_fast(forces)
            ? build_fast_group_forces(model.topology, model.fast.atoms, statics.memory.fast_pairs,
                                      groups, state.positions, statics.tile_skin)
            : build_group_forces(model.topology,
                                 has_end(forces.nonbonded) ? &statics.memory.list : nullptr,
                                 groups);
    statics.pulled = statics.across.atoms;
}

// Clusters of what is chosen, from forces and energies of everything that the state holds.
void rebuild_clusters(const TorsionModel& model, const AdaptiveSettings& settings,
                      TorsionState& state, AdaptiveStatics& statics) {
    build_clusters(model, state, statics);
    build_across(model, settings, state, statics);
    const EnergyTerms all = state.terms;
    statics.rounded_force = std::max(statics.rounded_force, find_rms(state.forces));
    statics.within_terms = {};
    update_across(model, settings, state, statics, statics.across_forces);
    if (statics.is_whole) {
        std::ranges::fill(statics.within_forces, Vec3::Zero());
        return;
    }
    statics.within_terms = all;
    statics.within_terms -= statics.across_terms;
    state.terms = all;
    statics.within_forces = state.forces;
    for (const std::uint32_t i : statics.pulled)
        statics.within_forces[i] -= statics.across_forces[i];
    (void)visit_spring_forces(model, state, [&](std::uint32_t atom, const Vec3& force) {
        statics.within_forces[atom] -= force;
    });
}

// From forces on all atoms.
void choose_joints(const TorsionModel& model, const AdaptiveSettings& settings, TorsionState& state,
                   AdaptiveStatics& statics) {
    update_pivots(model, state);
    guide_pivots(model, state, statics.whole);
    const bool is_settled = is_everything_chosen(model, settings.limits, statics);
    const auto update = statics.choices == 0 ? update_bodies : update_changed_bodies;
    statics.steps_since_choice = 0;
    ++statics.choices;
    if (is_settled) return;
    update(model.tree, state.positions, state.forces, statics.whole);
    upward_pass(model.tree, statics.whole);
    const MetricWeights weights{settings.weight, settings.factors};
    update_metric(model.tree, statics.whole, weights, statics.metric);
    select_joints(model.tree, statics.metric, weights, settings.limits, statics.whole,
                  statics.selection);
}

// Farther out the digits that are left do not tell a shape.
bool is_within_reach(const std::vector<Vec3>& positions) {
    constexpr double farthest = 1e6;  // Å
    return std::ranges::all_of(positions,
                               [](const Vec3& x) { return x.cwiseAbs().maxCoeff() < farthest; });
}

// Everything anew, list of pairs and all. False where that has no numbers.
[[nodiscard]] bool renew(const TorsionModel& model, const AdaptiveSettings& settings,
                         TorsionState& state, AdaptiveStatics& statics) {
    const bool is_new = !statics.is_built;
    statics.is_built = false;
    if (!is_within_reach(state.positions)) return false;
    update_forces(model, settings.step.forces, statics.memory, state);
    if (!std::isfinite(state.energy())) return false;
    if (is_new || statics.steps_since_choice >= settings.choose_every)
        choose_joints(model, settings, state, statics);
    statics.rounded_force = 0;
    rebuild_clusters(model, settings, state, statics);
    statics.is_built = true;
    statics.renewed_energy = state.energy();
    ++statics.renewals;
    return true;
}

bool is_choice_due(const AdaptiveSettings& settings, const AdaptiveStatics& statics) {
    return statics.steps_since_choice >= settings.choose_every;
}

// Of a state whose forces are complete.
bool is_renewal_due(const AdaptiveSettings& settings, const TorsionState& state,
                    const AdaptiveStatics& statics) {
    // What was rounded when forces were larger weighs too much after that.
    constexpr double much = 1000;  // kcal/mol
    if (statics.is_whole) return false;
    return statics.choices % settings.renew_every == 0 ||
           std::abs(state.energy() - statics.renewed_energy) > much ||
           find_rms(state.forces) < 0.5 * statics.rounded_force;
}

// False where energies are no numbers.
[[nodiscard]] bool choose_anew(const TorsionModel& model, const AdaptiveSettings& settings,
                               TorsionState& state, AdaptiveStatics& statics) {
    complete_forces(model, statics, state);
    if (is_renewal_due(settings, state, statics)) return renew(model, settings, state, statics);
    const std::vector<std::uint8_t> before = statics.selection.is_active;
    choose_joints(model, settings, state, statics);
    if (statics.selection.is_active != before ||
        are_tiles_outdated(settings, state, statics, settings.step.largest_move))
        rebuild_clusters(model, settings, state, statics);
    return true;
}

// ---- the step --------------------------------------------------------------------------------

// The whole of a move: a turn about the ground's point and a shift. A base that is guided at a
// point turns about that.
Vec6 base_move_of(const TorsionModel& model, const AdaptiveStatics& statics, std::size_t molecule,
                  double factor) {
    if (!may_base_move(model, statics, molecule)) return Vec6::Zero();
    const AssemblyState& passes = statics.moving.passes;
    Vec6 move = factor * passes.base_acceleration[molecule];
    const std::optional<Vec3>& pivot = passes.guides[molecule].point;
    if (model.bases[molecule].freedom == BaseFreedom::Turning && pivot) {
        const Vec3& ground = passes.points[statics.clusters.tree.bases[molecule]];
        const Vec3 turn = move.head<3>(), arm = ground - *pivot;
        move.tail<3>() = turn_of(turn) * arm - arm;
    }
    return move;
}

// Turns and base moves that are `factor` times the accelerations.
void set_moves(const TorsionModel& model, double factor, AdaptiveStatics& statics) {
    for (std::size_t c = 0; c < statics.turns.size(); ++c) {
        statics.turns[c] =
            is_base(statics, c) ? 0 : factor * statics.moving.passes.joint_acceleration[c];
    }
    for (std::size_t m = 0; m < statics.base_moves.size(); ++m) {
        statics.base_moves[m] = base_move_of(model, statics, m, factor);
    }
}

struct Accelerations {
    double norm;     // of all coordinates that move
    double largest;  // of any
    bool is_finite;
};

Accelerations find_accelerations(const TorsionModel& model, const AdaptiveStatics& statics) {
    double squares = 0, largest = 0;
    const auto add = [&](double value) {
        squares += value * value;
        largest = std::max(largest, std::abs(value));
    };
    const AssemblyState& passes = statics.moving.passes;
    for (std::size_t c = 0; c < statics.turns.size(); ++c) {
        if (!is_base(statics, c)) add(passes.joint_acceleration[c]);
    }
    for (std::size_t m = 0; m < statics.base_moves.size(); ++m) {
        if (!may_base_move(model, statics, m)) continue;
        const bool is_free = model.bases[m].freedom == BaseFreedom::Free;
        for (int i = 0; i < (is_free ? 6 : 3); ++i) add(passes.base_acceleration[m][i]);
    }
    return {std::sqrt(squares), largest, std::isfinite(squares)};
}

void mark_moved(AdaptiveStatics& statics) {
    const HybridTree& clusters = statics.clusters;
    for (std::size_t c = 0; c < statics.is_moved.size(); ++c) {
        statics.is_moved[c] =
            is_base(statics, c) ? statics.base_moves[clusters.tree.molecule_of[c]] != Vec6::Zero()
                                : statics.turns[c] != 0 ||
                                      statics.is_moved[clusters.tree.bodies.bodies[c].parent] != 0;
        statics.has_moved[c] |= statics.is_moved[c];
    }
}

void keep_start(const TorsionState& state, AdaptiveStatics& statics) {
    statics.start.orientations = statics.moving.orientations;
    statics.start.centres = statics.moving.centres;
    statics.start.passes.bodies = statics.moving.passes.bodies;
    statics.start.passes.guides = statics.moving.passes.guides;
    for (std::size_t c = 0; c < statics.is_moved.size(); ++c) {
        if (statics.is_moved[c] == 0) continue;
        for (const std::uint32_t i : atoms_of(statics.clusters, c))
            statics.positions[i] = state.positions[i];
    }
}

void go_back(AdaptiveStatics& statics) {
    statics.moving.orientations = statics.start.orientations;
    statics.moving.centres = statics.start.centres;
    statics.moving.passes.bodies = statics.start.passes.bodies;
    statics.moving.passes.guides = statics.start.passes.guides;
}

// Puts atoms where their clusters are; returns how far the farthest went.
double place_moved(TorsionState& state, AdaptiveStatics& statics) {
    double farthest2 = 0;
    for (std::uint32_t c = 0; c < statics.is_moved.size(); ++c) {
        if (statics.is_moved[c] == 0) continue;
        update_positions(statics.clusters, statics.moving, c, state.positions);
        for (const std::uint32_t i : atoms_of(statics.clusters, c)) {
            farthest2 =
                std::max(farthest2, (state.positions[i] - statics.positions[i]).squaredNorm());
        }
    }
    return std::sqrt(farthest2);
}

struct Placed {
    double factor;    // of the accelerations
    double farthest;  // that any atom went, Å
};

// As place_within does: by `factor` times the accelerations, or by so much less that no atom goes
// farther than the largest move.
Placed place_within(const TorsionModel& model, const Accelerations& accelerations, double factor,
                    double largest_move, TorsionState& state, AdaptiveStatics& statics) {
    constexpr double widest = 0.5;  // rad or Å: atoms go about straight
    if (factor * accelerations.largest > widest) factor = widest / accelerations.largest;
    set_moves(model, factor, statics);
    mark_moved(statics);
    keep_start(state, statics);
    constexpr int tries = 30;
    for (int i = 0;; ++i) {
        move_clusters(statics.clusters, statics.turns, statics.base_moves, statics.moving);
        const double farthest = place_moved(state, statics);
        if (!(farthest > largest_move)) return {factor, farthest};
        factor *= i < tries ? 0.999 * largest_move / farthest : 0.0;
        go_back(statics);
        set_moves(model, factor, statics);
    }
}

// What forces at both ends say about the work along a move: the fall of the energy.
double find_work(const AdaptiveStatics& statics) {
    double work = 0;
    for (std::size_t c = 0; c < statics.is_moved.size(); ++c) {
        if (statics.is_moved[c] == 0) continue;
        const BodyState& from = statics.start.passes.bodies[c];
        const BodyState& to = statics.moving.passes.bodies[c];
        const Vec3 turned = rotation_vector_of(Quat(statics.moving.motions[c].rotation));
        const Vec3 shifted = statics.moving.centres[c] - statics.start.centres[c];
        work +=
            0.5 * ((from.torque + to.torque).dot(turned) + (from.force + to.force).dot(shifted));
    }
    return work;
}

void take_coordinates(const TorsionModel& model, const AdaptiveStatics& statics,
                      TorsionState& state) {
    for (std::size_t c = 0; c < statics.turns.size(); ++c) {
        if (!is_base(statics, c)) state.angles[statics.clusters.body_of[c]] += statics.turns[c];
    }
    for (std::size_t m = 0; m < model.bases.size(); ++m) {
        const std::uint32_t base = statics.clusters.tree.bases[m];
        if (statics.is_moved[base] == 0) continue;
        const RigidMotion& motion = statics.moving.motions[base];
        state.turns[m] = (Eigen::Quaterniond(motion.rotation) * state.turns[m]).normalized();
        state.shifts[m] = motion * state.shifts[m];
    }
}

// ---- hands -----------------------------------------------------------------------------------

void take_in_hand(std::size_t molecule, AdaptiveStatics& statics) {
    if (statics.is_guided[molecule] != 0) return;
    // Until now it was at rest against others.
    statics.is_guided[molecule] = 1;
    statics.is_built = false;
}

template <class Visit>
void visit_atoms_of(const TorsionModel& model, std::size_t molecule, const Visit& visit) {
    for (std::uint32_t i = 0; i < model.masses.size(); ++i) {
        if (model.tree.molecule_of[model.tree.bodies.body_of[i]] == molecule) visit(i);
    }
}

// Where a base turns about, from the positions as they are now.
Vec3 find_pivot(const TorsionModel& model, const TorsionState& state, std::size_t molecule) {
    const MoleculeBase& base = model.bases[molecule];
    if (base.freedom != BaseFreedom::Free) return state.positions[base.pivot];
    Vec3 moment = Vec3::Zero();
    visit_atoms_of(model, molecule,
                   [&](std::uint32_t i) { moment += model.masses[i] * state.positions[i]; });
    return moment / model.molecule_masses[molecule];
}

// How far a motion takes any atom of a molecule, Å.
double find_farthest(const TorsionModel& model, const TorsionState& state, std::size_t molecule,
                     const RigidMotion& motion) {
    double farthest2 = 0;
    visit_atoms_of(model, molecule, [&](std::uint32_t i) {
        const Vec3& x = state.positions[i];
        farthest2 = std::max(farthest2, (motion * x - x).squaredNorm());
    });
    return std::sqrt(farthest2);
}

template <class Visit>
void visit_clusters_of(const AdaptiveStatics& statics, std::size_t molecule, const Visit& visit) {
    for (std::uint32_t c = 0; c < statics.clusters.clusters.size(); ++c) {
        if (statics.clusters.tree.molecule_of[c] == molecule) visit(c);
    }
}

}  // namespace

AdaptiveStatics build_adaptive_statics(const TorsionModel& model) {
    AdaptiveStatics statics;
    statics.whole = build_quasi_statics(model).assembly;
    statics.metric = build_acceleration_metric(model.tree);
    statics.selection = build_joint_selection(model.tree);
    statics.is_guided.assign(model.bases.size(), 0);
    statics.shifts.assign(model.bases.size(), 0);
    for (std::vector<Vec3>* vectors : {&statics.across_forces, &statics.trial_forces,
                                       &statics.within_forces, &statics.positions}) {
        vectors->assign(model.reference.size(), Vec3::Zero());
    }
    return statics;
}

void shift_base(const TorsionModel& model, std::size_t molecule, const Vec3& by,
                TorsionState& state, AdaptiveStatics& statics) noexcept {
    take_in_hand(molecule, statics);
    statics.shifts[molecule] = by.norm();
    if (!statics.is_built) {
        shift_base(model, molecule, by, state);
        return;
    }
    state.shifts[molecule] += by;
    std::optional<Vec3>& guided = statics.moving.passes.guides[molecule].point;
    if (guided) *guided += by;
    visit_clusters_of(statics, molecule, [&](std::uint32_t c) {
        statics.moving.centres[c] += by;
        statics.is_moved[c] = statics.has_moved[c] = 1;
        update_positions(statics.clusters, statics.moving, c, state.positions);
    });
}

void turn_base(const TorsionModel& model, std::size_t molecule, const Eigen::Quaterniond& turn,
               const Vec3& by, TorsionState& state, AdaptiveStatics& statics) noexcept {
    take_in_hand(molecule, statics);
    const Vec3 pivot = find_pivot(model, state, molecule);
    const Mat3 rotation = turn.toRotationMatrix();
    const RigidMotion motion{rotation, pivot - rotation * pivot + by};
    statics.shifts[molecule] = find_farthest(model, state, molecule, motion);
    state.turns[molecule] = (turn * state.turns[molecule]).normalized();
    state.shifts[molecule] = motion * state.shifts[molecule];
    if (!statics.is_built) {
        update_positions(model, state);
        return;
    }
    std::optional<Vec3>& guided = statics.moving.passes.guides[molecule].point;
    if (guided) guided = motion * *guided;
    visit_clusters_of(statics, molecule, [&](std::uint32_t c) {
        HybridState& moving = statics.moving;
        moving.centres[c] = motion * moving.centres[c];
        moving.orientations[c] = (turn * moving.orientations[c]).normalized();
        statics.is_moved[c] = statics.has_moved[c] = 1;
        update_positions(statics.clusters, moving, c, state.positions);
    });
}

bool update_adaptive_forces(const TorsionModel& model, const AdaptiveSettings& settings,
                            TorsionState& state, AdaptiveStatics& statics) {
    if (!statics.is_built || is_list_outdated(model, settings, state, statics) ||
        are_tiles_outdated(settings, state, statics, 0) || !is_within_reach(state.positions))
        return renew(model, settings, state, statics);
    update_across(model, settings, state, statics, statics.across_forces);
    return std::isfinite(state.energy());
}

AdaptiveReport step_adaptive(const TorsionModel& model, const AdaptiveSettings& settings,
                             TorsionState& state, AdaptiveStatics& statics) {
    PALPA_ASSERT(settings.choose_every > 0 && settings.renew_every > 0);
    if (statics.h == 0) statics.h = settings.step.first_h;
    const std::size_t choices = statics.choices;
    AdaptiveReport result;
    QuasiStaticReport& report = result.step;
    if (!statics.is_built || is_list_outdated(model, settings, state, statics)) {
        report.is_finite = renew(model, settings, state, statics);
    } else if (is_choice_due(settings, statics)) {
        report.is_finite = choose_anew(model, settings, state, statics);
    } else if (are_tiles_outdated(settings, state, statics, settings.step.largest_move)) {
        complete_forces(model, statics, state);
        rebuild_clusters(model, settings, state, statics);
    }
    if (!report.is_finite) return result;
    ++statics.steps_since_choice;

    result.is_chosen = statics.choices != choices;
    update_accelerations(statics.clusters, statics.moving);
    const Accelerations accelerations = find_accelerations(model, statics);
    report.is_finite = accelerations.is_finite;
    if (!report.is_finite) return result;
    const double wanted = 0.5 * statics.h * statics.h;
    const auto [factor, farthest] =
        place_within(model, accelerations, wanted, settings.step.largest_move, state, statics);
    report.largest_move = farthest;
    report.is_bounded = factor < wanted && accelerations.norm > 0;

    const double before = state.energy();
    const EnergyTerms terms = state.terms, across_terms = statics.across_terms;
    const double spring_energy = state.spring_energy;
    update_across(model, settings, state, statics, statics.trial_forces);
    report.energy_change = state.energy() - before;
    const double magnitude = across_terms.magnitude() + spring_energy;
    const bool is_lower = is_energy_lower(settings.step.forces, magnitude, report.energy_change,
                                          [&] { return find_work(statics); });
    report.is_taken = std::isfinite(report.energy_change) && is_lower;
    if (report.is_bounded) statics.h *= std::sqrt(factor / wanted);
    if (!report.is_taken) {
        statics.h *= settings.step.shrinkage;
        go_back(statics);
        (void)place_moved(state, statics);
        state.terms = terms;
        state.spring_energy = spring_energy;
        statics.across_terms = across_terms;
        return result;
    }
    if (accelerations.norm > 0) statics.h = std::min(longest_h, settings.step.growth * statics.h);
    std::swap(statics.across_forces, statics.trial_forces);
    take_coordinates(model, statics, state);
    return result;
}

void complete_forces(const TorsionModel& model, const AdaptiveStatics& statics,
                     TorsionState& state) noexcept {
    if (!statics.is_built) return;
    for (std::size_t c = 0; c < statics.clusters.clusters.size(); ++c) {
        const Mat3 turn = statics.moving.orientations[c].toRotationMatrix();
        for (const std::uint32_t i : atoms_of(statics.clusters, c))
            state.forces[i] = turn * statics.within_forces[i];
    }
    for (const std::uint32_t i : statics.pulled) state.forces[i] += statics.across_forces[i];
    (void)visit_spring_forces(
        model, state, [&](std::uint32_t atom, const Vec3& force) { state.forces[atom] += force; });
}

Vec6 find_wrench_on(const AdaptiveStatics& statics, std::size_t molecule) noexcept {
    Vec6 wrench = Vec6::Zero();
    for (std::size_t c = 0; c < statics.clusters.clusters.size(); ++c) {
        if (statics.clusters.tree.molecule_of[c] != molecule) continue;
        const BodyState& body = statics.moving.passes.bodies[c];
        wrench.head<3>() += body.torque + body.centre.cross(body.force);
        wrench.tail<3>() += body.force;
    }
    return wrench;
}

std::size_t find_active_freedom(const TorsionModel& model,
                                const AdaptiveStatics& statics) noexcept {
    std::size_t freedom = statics.clusters.tree.bodies.joints();
    for (std::size_t m = 0; m < model.bases.size(); ++m) {
        if (may_base_move(model, statics, m))
            freedom += degrees_of_freedom(statics.moving.passes.guides[m].guide);
    }
    return freedom;
}

AdaptiveDeviation find_deviation(const TorsionModel& model, const AdaptiveSettings& settings,
                                 const TorsionState& state, const AdaptiveStatics& statics) {
    TorsionState completed = state, anew = state;
    complete_forces(model, statics, completed);
    update_positions(model, anew);
    AdaptiveDeviation deviation;
    deviation.position = find_largest_move(state.positions, anew.positions);
    anew.positions = state.positions;
    ForceMemory memory;
    update_forces(model, settings.step.forces, memory, anew);
    const double rms = find_rms(anew.forces);
    for (std::size_t i = 0; i < anew.forces.size(); ++i) {
        const double size = std::max({anew.forces[i].norm(), rms, 1e-300});
        deviation.force =
            std::max(deviation.force, (completed.forces[i] - anew.forces[i]).norm() / size);
    }
    deviation.energy = std::abs(anew.energy() - state.energy());
    return deviation;
}

}  // namespace palpa
