// How what is mobile moves in a step. A world has one solver; what differs between them is asked
// here alone.
#pragma once
#include "ecs/world.h"
#include "simulation/paper_step.h"
#include "simulation/relaxed_contact.h"
#include "simulation/remote_engine.h"
#include "simulation/second_order.h"
#include "simulation/systems/step_input.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace palpa {

// Nothing moves but rigid molecules that hands hold as a whole.
struct Rigid {};

// Resource. A world without it is rigid.
struct Solver {
    std::variant<Rigid, PaperStep, SecondOrder, RemoteEngine> kind;

    Solver without_caches() const;
    std::size_t count_bytes() const noexcept;
};

// The solver if it is of this kind; else null. For the files of the solvers, and for measurements.
template <class Kind>
const Kind* find_solver(const World& world) noexcept {
    const Solver* const solver = world.find_resource<Solver>();
    return solver ? std::get_if<Kind>(&solver->kind) : nullptr;
}
template <class Kind>
Kind* write_solver(World& world) {
    return find_solver<Kind>(world) ? std::get_if<Kind>(&world.write<Solver>().kind) : nullptr;
}

// ---- building -----------------------------------------------------------------------------------

// Builds the solver that the settings ask for (statics.method), for a world with its model; gathers
// the springs. Matrices of more than most_second_order_coordinates are too large for second order.
// Throws LoadError where the scene asks for it nevertheless.
void build_solver(std::span<const HeldPart> held, World& world);

// The settings of a relaxation step by the scene.
QuasiStaticSettings build_step_settings(const World& world);

// Computes the forces of the present state, from which steps start.
void start_solver(World& world);

// Starts from another state without any history.
void put_state(World& world, const TorsionState& state);

// Rebuilds the caches after a transaction that was rolled back.
void restore_caches(World& world) noexcept;

// ---- a step -------------------------------------------------------------------------------------

// Before the systems.
void before_step(World& world, const StepInput& input);

// Moves mobile joints and bases towards rest, or to what a remote engine sent. Nothing if rigid, or
// without steps of its own.
std::optional<RelaxStepReport> relax_mobile(World& world, const StepInput& input);

// After the systems: error estimates. Then the time that all took.
void after_step(World& world);
void note_time(World& world);

// Copies positions that the mechanics have changed since the last call to the table.
void copy_positions(World& world);

// Moves what the hand holds in the mechanics. A base that the handle turns is turned as well.
void move_mobile(World& world, Entity hand, const Vec3& by, const Quat& turn) noexcept;

// Sets the tolerance of force errors, pN.
void set_tolerance(World& world, double within_pN);

// The pending renewal that another thread may make; nothing without one.
struct RenewalWork {
    const TorsionModel& model;
    const SecondOrderSettings& settings;
    SecondOrderStatics& statics;
};
std::optional<RenewalWork> find_renewal(World& world);

// ---- answers ------------------------------------------------------------------------------------

// True unless a remote engine places the atoms: then edits and undo cannot, and hands hold by
// springs alone.
bool places_atoms(const World& world) noexcept;

// True if a model says how everything follows the hands.
bool follows_by_model(const World& world) noexcept;

// Number of degrees of freedom that can move now.
std::size_t find_active_freedom(const World& world) noexcept;

// Force on the mobile molecule that the hand moves, or on the hand's end of its spring, kcal/mol/Å.
// Zero if it holds nothing or a rigid molecule outside of the mechanics; the same holds for the
// next function.
Vec3 find_force_on_held(const World& world, Entity hand) noexcept;
// Force and torque about the origin on the molecule that the hand moves, from all other molecules.
Vec6 find_pull_on_held(const World& world, Entity hand) noexcept;

// The answers of relaxed_contact.h by the linearised model; nothing, or zero, without one.
std::optional<RelaxedStiffness> find_relaxed_stiffness(const World& world, Entity hand);
Mat3 find_relaxed_coupling(const World& world, Entity hand, Entity other);
std::optional<FollowingAtoms> find_following(const World& world, Entity hand,
                                             const LocalField& field,
                                             std::span<const std::uint32_t> environment);

// Energy of the mobile parts, kcal/mol, without constant terms and without the springs of clients.
double find_energy(const World& world) noexcept;

// The last error estimate of the force on a hand, pN; with second order, the largest of all hands.
// `find_error` makes new ones.
std::optional<double> find_error_estimate(const World& world, Entity hand);
void find_error(World& world);

// The controller of the work, if the scene sets an accuracy that needs one.
const AccuracyController* find_accuracy_controller(const World& world) noexcept;

// The relative error that the force of a client may have before its spring is moved.
double client_force_tolerance(const World& world) noexcept;

std::optional<Snap> find_last_snap(const World& world) noexcept;

// Evaluations of all forces so far, and how many of them single precision could not do.
struct ForceCount {
    std::size_t all = 0, in_double = 0;
};
ForceCount count_forces(const World& world) noexcept;

// The values by which a picture colours joints.
enum class JointActivity : std::uint8_t {
    Nothing,
    Active,            // 1: active now
    BeyondFirstOrder,  // the joint's angle beyond first order, rad
};
JointActivity joint_activity(const World& world) noexcept;
// One value per body; empty for Nothing.
std::vector<double> find_joint_activity(const World& world);
// The estimated error of each body's joint, rad; nothing without an estimate.
std::optional<std::vector<double>> estimate_joint_errors(const World& world);

}  // namespace palpa
