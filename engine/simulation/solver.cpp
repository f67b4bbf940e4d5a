#include "simulation/solver.h"

#include "core/load_error.h"
#include "core/units.h"
#include "simulation/grip_queries.h"
#include "simulation/solvent.h"
#include "simulation/systems/follow_engine.h"
#include "simulation/systems/gather_springs.h"
#include "simulation/systems/pull_by_clients.h"
#include "statics/joint_answers.h"

#include <fmt/format.h>
#include <utility>

namespace palpa {
namespace {

template <class... Cases>
struct Match : Cases... {
    using Cases::operator()...;
};

// Calls the case of the world's solver; a rigid one is not written.
template <class... Cases>
auto match(const World& world, const Cases&... cases) {
    const Match match{cases...};
    const Solver* const solver = world.find_resource<Solver>();
    return solver ? std::visit(match, solver->kind) : match(Rigid{});
}
template <class... Cases>
auto match(World& world, const Cases&... cases) {
    const Match match{cases...};
    const Solver* const solver = world.find_resource<Solver>();
    const bool is_rigid = !solver || std::holds_alternative<Rigid>(solver->kind);
    return is_rigid ? match(Rigid{}) : std::visit(match, world.write<Solver>().kind);
}

// The second-order model in force; null without one.
const SecondOrder* find_model(const World& world) noexcept {
    const SecondOrder* const second = find_solver<SecondOrder>(world);
    return second && second->statics.linear ? second : nullptr;
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

}  // namespace

Solver Solver::without_caches() const {
    const auto kept = Match{
        [](const auto& kind) { return Solver{kind}; },
        [](const PaperStep& paper) { return Solver{paper.without_caches()}; },
        [](const SecondOrder& second) { return Solver{second.without_caches()}; },
    };
    return std::visit(kept, kind);
}

std::size_t Solver::count_bytes() const noexcept {
    const auto count = Match{
        [](const auto& /*kind*/) { return std::size_t{0}; },
        [](const PaperStep& paper) { return paper.count_bytes(); },
        [](const SecondOrder& second) { return second.count_bytes(); },
    };
    return std::visit(count, kind);
}

// ---- building -----------------------------------------------------------------------------------

QuasiStaticSettings build_step_settings(const World& world) {
    const StaticsDescription& s = world.resource<MechanicsSettings>().statics;
    const ForceFieldDescription& force_field = world.resource<ForceFieldInUse>().description;
    QuasiStaticSettings settings;
    settings.largest_move = s.largest_move_angstrom;
    ForceSettings& forces = settings.forces;
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

void build_solver(std::span<const HeldPart> held, World& world) {
    const TorsionModel& model = model_of(world);
    const QuasiStaticSettings settings = build_step_settings(world);
    gather_springs(world, {});
    if (find_method(world, model.coordinates) == RelaxMethod::SecondOrder) {
        world.set_resource(Solver{build_second_order(settings, world)});
        return;
    }
    PaperStep paper = build_paper_step(settings, model, held, world);
    if (model.coordinates <= most_second_order_coordinates)
        paper.estimate = build_error_estimate(settings, world);
    world.set_resource(Solver{std::move(paper)});
}

void start_solver(World& world) {
    if (!has_mobile(world)) return;
    match(
        world, [](const auto& /*other*/) {}, [&](PaperStep& paper) { start(world, paper); },
        [&](SecondOrder& second) { start(world, second); });
}

void put_state(World& world, const TorsionState& state) {
    world.write<TorsionState>() = state;
    match(
        world, [](const auto& /*other*/) {}, [&](PaperStep& paper) { restart(world, paper); },
        [&](SecondOrder& second) { restart(world, second); });
    update_positions(model_of(world), world.write<TorsionState>());
    return_ends(world);
    start_solver(world);
}

void restore_caches(World& world) noexcept {
    if (!has_mobile(world)) return;
    match(
        world, [](const auto& /*other*/) {}, [&](PaperStep& paper) { restore(world, paper); },
        [&](SecondOrder& second) { restore(world, second); });
}

// ---- a step -------------------------------------------------------------------------------------

void before_step(World& world, const StepInput& input) {
    match(
        world, [](const auto& /*other*/) {},
        [&](PaperStep& paper) { before_step(world, paper, input); });
}

std::optional<RelaxStepReport> relax_mobile(World& world, const StepInput& input) {
    using Report = std::optional<RelaxStepReport>;
    Report report = match(
        world, [](const Rigid& /*rigid*/) { return Report{}; },
        [&](PaperStep& paper) { return Report{relax(world, paper, input)}; },
        [&](SecondOrder& second) { return Report{relax(world, second, input)}; },
        [&](RemoteEngine& engine) {
            follow_engine(world, engine);
            return Report{};
        });
    if (report) return_ends(world);
    return report;
}

void after_step(World& world) {
    match(world, [](const auto& /*other*/) {}, [&](PaperStep& paper) { after_step(world, paper); });
}

void note_time(World& world) {
    const StepReport& report = world.resource<StepReport>();
    if (!report.relaxed) return;
    match(
        world, [](const auto& /*other*/) {}, [&](PaperStep& paper) { note_time(report, paper); },
        [&](SecondOrder& second) { note_time(world, report, second); });
}

void copy_positions(World& world) {
    if (world.resource<TorsionState>().positions.empty()) return;
    if (PaperStep* const paper = write_solver<PaperStep>(world))
        return copy_positions(world, *paper);
    put_in_table(model_of(world), model_atoms_of(world), world.resource<TorsionState>().positions,
                 world.write<AtomTable>().positions);
}

void move_mobile(World& world, Entity hand, const Vec3& by, const Quat& turn) noexcept {
    const Grip& grip = grip_of(world, hand);
    const TorsionModel& model = model_of(world);
    TorsionState& state = world.write<TorsionState>();
    if (const std::optional<std::size_t> index = find_spring_index(world, hand)) {
        state.springs[*index].place += by;
        world.write<Spring>(hand)->place = state.springs[*index].place;
        return;
    }
    const auto base = static_cast<std::size_t>(grip.base);
    const bool turns = grip.freedom == 6 && turn.vec() != Vec3::Zero();
    if (PaperStep* const paper = write_solver<PaperStep>(world)) {
        turns ? turn_base(model, base, turn, by, state, paper->statics)
              : shift_base(model, base, by, state, paper->statics);
    } else {
        turns ? turn_base(model, base, turn, by, state) : shift_base(model, base, by, state);
    }
}

void set_tolerance(World& world, double within_pN) {
    match(
        world, [](const auto& /*other*/) {},
        [&](PaperStep& paper) {
            if (paper.accuracy) paper.accuracy->set_tolerance(within_pN);
        },
        [&](SecondOrder& second) {
            second.settings.tolerance = within_pN / units::piconewton_per_kcal_per_mol_angstrom;
        });
}

std::optional<RenewalWork> find_renewal(World& world) {
    const SecondOrder* const second = find_solver<SecondOrder>(world);
    if (!second || !second->statics.pending) return {};
    SecondOrder& written = *write_solver<SecondOrder>(world);
    return RenewalWork{model_of(world), written.settings, written.statics};
}

// ---- answers ------------------------------------------------------------------------------------

bool places_atoms(const World& world) noexcept { return !find_solver<RemoteEngine>(world); }

bool follows_by_model(const World& world) noexcept { return find_model(world); }

std::size_t find_active_freedom(const World& world) noexcept {
    const PaperStep* const paper = find_solver<PaperStep>(world);
    return paper ? find_active_freedom(model_of(world), paper->statics)
                 : static_cast<std::size_t>(model_of(world).coordinates);
}

Vec3 find_force_on_held(const World& world, Entity hand) noexcept {
    if (!world.find<Grip>(hand) || !is_mobile(world, hand)) return Vec3::Zero();
    return match(
        world, [](const auto& /*other*/) { return Vec3(Vec3::Zero()); },
        [&](const PaperStep& paper) { return find_force(world, paper, hand); },
        [&](const SecondOrder& second) { return find_force(world, second, hand); });
}

Vec6 find_pull_on_held(const World& world, Entity hand) noexcept {
    const Grip* const grip = world.find<Grip>(hand);
    if (!grip || grip->base < 0) return Vec6::Zero();
    return match(
        world, [](const auto& /*other*/) { return Vec6(Vec6::Zero()); },
        [&](const PaperStep& paper) { return find_pull(world, paper, hand); },
        [&](const SecondOrder& second) { return find_pull(world, second, hand); });
}

std::optional<RelaxedStiffness> find_relaxed_stiffness(const World& world, Entity hand) {
    const SecondOrder* const second = find_model(world);
    return second ? find_relaxed_stiffness(world, *second, hand) : std::nullopt;
}

Mat3 find_relaxed_coupling(const World& world, Entity hand, Entity other) {
    const SecondOrder* const second = find_model(world);
    return second ? find_relaxed_coupling(world, *second, hand, other) : Mat3::Zero();
}

std::optional<FollowingAtoms> find_following(const World& world, Entity hand,
                                             const LocalField& field,
                                             std::span<const std::uint32_t> environment) {
    const SecondOrder* const second = find_model(world);
    return second ? find_following(world, *second, hand, field, environment) : std::nullopt;
}

double find_energy(const World& world) noexcept {
    const SecondOrder* const second = find_model(world);
    const double energy =
        second ? second->statics.value.energy : world.resource<TorsionState>().energy();
    return energy - find_client_energy(world);
}

std::optional<double> find_error_estimate(const World& world, Entity hand) {
    const PaperStep* const paper = find_solver<PaperStep>(world);
    if (paper && paper->estimate) {
        const std::vector<Entity> hands = find_hands(world);
        const auto slot = static_cast<std::size_t>(std::ranges::find(hands, hand) - hands.begin());
        return paper->estimate->last_pN.at(slot);
    }
    const std::optional<RelaxStepReport>& relaxed = world.resource<StepReport>().relaxed;
    return relaxed ? relaxed->estimated_error_pN : std::nullopt;
}

void find_error(World& world) {
    if (PaperStep* const paper = write_solver<PaperStep>(world)) find_error(world, *paper);
}

const AccuracyController* find_accuracy_controller(const World& world) noexcept {
    const PaperStep* const paper = find_solver<PaperStep>(world);
    return paper && paper->accuracy ? &*paper->accuracy : nullptr;
}

double client_force_tolerance(const World& world) noexcept {
    return find_solver<SecondOrder>(world) ? 0.02 : 0;
}

std::optional<Snap> find_last_snap(const World& world) noexcept {
    const SecondOrder* const second = find_solver<SecondOrder>(world);
    return second ? second->snap : std::nullopt;
}

ForceCount count_forces(const World& world) noexcept {
    const auto count = [](const ForceMemory& memory) {
        return ForceCount{memory.evaluations, memory.fast_pairs.in_double};
    };
    return match(
        world, [](const auto& /*other*/) { return ForceCount{}; },
        [&](const PaperStep& paper) { return count(paper.statics.memory); },
        [&](const SecondOrder& second) { return count(second.statics.renewals.full.memory); });
}

JointActivity joint_activity(const World& world) noexcept {
    return match(
        world, [](const auto& /*other*/) { return JointActivity::Nothing; },
        [](const PaperStep& /*paper*/) { return JointActivity::Active; },
        [](const SecondOrder& /*second*/) { return JointActivity::BeyondFirstOrder; });
}

std::vector<double> find_joint_activity(const World& world) {
    return match(
        world, [](const auto& /*other*/) { return std::vector<double>{}; },
        [](const PaperStep& paper) {
            const auto& is_active = paper.statics.selection.is_active;
            return std::vector<double>(is_active.begin(), is_active.end());
        },
        [&](const SecondOrder& second) {
            return find_beyond_first_order(model_of(world), second.statics);
        });
}

std::optional<std::vector<double>> estimate_joint_errors(const World& world) {
    const SecondOrder* const second = find_solver<SecondOrder>(world);
    if (!second) return {};
    return estimate_joint_errors(model_of(world), second->settings, world.resource<TorsionState>(),
                                 second->statics);
}

}  // namespace palpa
