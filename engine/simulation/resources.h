// What a world has one of.
#pragma once
#include "ecs/entity.h"
#include "field/pair_field.h"
#include "haptics/gains.h"
#include "math/vec.h"
#include "molecule/atoms.h"
#include "scene/description.h"
#include "simulation/accuracy_controller.h"
#include "simulation/relax.h"
#include "statics/adaptive_step.h"
#include "statics/relax_joints.h"
#include "statics/second_order_step.h"
#include "statics/time_budget.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace palpa {

struct Connectivity;
struct ForceField;
struct Topology;

// What the world was loaded from, and may be added from.
struct SceneFile {
    SceneDescription scene;
    std::shared_ptr<const ForceField> force_field;
    CouplingDescription coupling;  // the file's; the scene has what edits make of it
};

// What all molecules are together, in the order of the table; empty until something mobile asks.
struct BondedTerms {
    std::shared_ptr<const Connectivity> connectivity;
    std::shared_ptr<const Topology> topology;
};

// Beside these: the AtomTable, whose positions every step writes, the TorsionState, without atoms
// where nothing is mobile, and where clients pull a ClientPull.

// Stands for which atoms, molecules and bonds there are. Copies of a world share it; where any were
// added or removed it is another one, which is equal to no other.
struct AtomEdition {
    std::shared_ptr<const int> mark;

    friend bool operator==(const AtomEdition&, const AtomEdition&) = default;
};

// What atoms do to each other, beside what the table says of each.
struct Interactions {
    double coulomb_constant = 0;                    // kcal Å/mol/e^2; over eps with smooth ends
    std::vector<ReplacedPair> replaced_pairs;       // of types in the table
    std::optional<SmoothEnds> smooth;               // with implicit solvent
    PairPrecision precision = PairPrecision::Fast;  // of steps: see fast_field_on_held
};

// Between hands and molecules.
struct Coupling {
    CouplingLaws laws;
    bool is_guarded = false;               // the servo moves the molecule
    std::size_t pairs_per_tick = 130'000;  // that it has time for
};

struct Clock {
    double period_s = 0;  // declared, of a step
    std::uint64_t steps = 0;
    std::uint64_t resets = 0;  // by edits, which leave the steps counted on
};

// Which atoms of the table a model has.
struct ModelAtoms {
    // Of each of its atoms the table's number, rising. Empty: it has all, by the same numbers.
    std::vector<std::uint32_t> in_table;

    std::uint32_t number_in_table(std::uint32_t in_model) const noexcept {
        return in_table.empty() ? in_model : in_table[in_model];
    }
    // Nothing where the model does not have it.
    std::optional<std::uint32_t> in_model(std::uint32_t number_in_table) const noexcept;
};

// Writes the places of mobile atoms to the table's.
void put_in_table(const TorsionModel& model, const ModelAtoms& atoms,
                  const std::vector<Vec3>& positions, std::vector<Vec3>& table);

// The mobile molecules as torsion bodies; without atoms where there are none. Copies of a world
// share it.
struct Mechanics {
    std::shared_ptr<const TorsionModel> model = std::make_shared<const TorsionModel>();
    std::shared_ptr<const ModelAtoms> atoms = std::make_shared<const ModelAtoms>();
};

// How what is mobile comes towards rest.
struct Solver {
    RelaxSettings settings;  // of every step
    QuasiStatics statics;
    TorsionState safe;  // where the last step left it
};

struct Ball {
    Vec3 centre;  // Å
    double radius;
};

// Where not everything is active at a time, or the scene says how exact forces must be.
struct AdaptiveState {
    AdaptiveSettings settings;
    AdaptiveStatics statics;
    std::optional<TimeBudget> budget;
    // Where the scene says how exact forces must be, and what finds out.
    std::optional<AccuracyController> accuracy;
    // Before a step: what was rendered to the first hand where it now is, kcal/mol/Å; nothing: what
    // the step itself finds.
    std::optional<Vec3> rendered;
    std::size_t choose_every = 0;  // steps, as the scene says
    // How much each joint counts for what it moves; empty where all do alike. And whether what is
    // near to hands counts more, and around what that was found last.
    std::vector<double> mobility_weights;
    bool weighs_hand_proximity = false;
    std::vector<Ball> near_to;  // of each hand
    std::size_t copied = 0;     // rebuilds of the clusters when positions were copied in full
};

// Where steps do not relax everything, by how much the force on the first hand differs from that of
// complete relaxation: found now and then on a copy.
struct ErrorEstimate {
    SecondOrderSettings settings;
    HeldParts held;
    std::optional<RenewalMemory> memory;  // from the first estimate on
    std::size_t steps = 0;                // of the simulation
    std::optional<double> last_pN;
    Vec3 felt_pN = Vec3::Zero();  // the force then
    std::size_t evaluations = 0;  // that it took
};

// A renewal that sets more energy free than this (kcal/mol) is a snap: a minimum had vanished.
inline constexpr double least_snap = 1;

// Where everything mobile follows the hands by second order.
struct SecondOrder {
    SecondOrderSettings settings;
    SecondOrderStatics statics;
    std::vector<Entity> hands;  // in the order in which the statics have them

    // Until a pending renewal is used, steps go on with the old model: for a declared time, or
    // until the step's input says so.
    std::optional<double> delay_s;
    std::uint64_t due = 0;  // step of the clock, where a delay is declared

    // In real time, where no delay is declared, a step has as many evaluations of the model as fit
    // into most of the period: by how long each of the last took, wall time.
    std::size_t most_evaluations = 0;
    double evaluation_us = 0;

    // The last time that a minimum had vanished: energy that renewals set free (kcal/mol), the
    // atom that went farthest, and the clock's step.
    struct Snap {
        std::uint32_t atom = 0;
        double released = 0;
        std::uint64_t step = 0;
    };
    std::optional<Snap> snap;
};

// How the scene came to its start.
struct StartReport {
    std::optional<RelaxReport> rigid;  // the molecule in the hand, where it is rigid in space
    std::optional<JointRelaxReport> joints_at_rest;  // everything mobile
    std::size_t joints = 0;                          // in all
    std::size_t joints_held = 0;  // that the rules would turn, were it not for the region
};

// What a hand's move was.
struct HandMove {
    double angstrom = 0;  // how far it moved what it holds
    // A_d that decided it, where the servo has not.
    std::optional<double> displacement_gain;
};

struct [[nodiscard]] RelaxStepReport {
    double hand_work = 0;      // kcal/mol, by which moving what hands hold raised the energy
    double energy_change = 0;  // kcal/mol, by coming to rest: above 0 only by rounding
    double largest_move = 0;   // of any atom, Å
    std::size_t evaluations = 0;
    std::size_t active = 0;  // degrees of freedom that could move
    std::size_t steps = 0;   // towards rest
    // How far the force on the hand was from what all joints give (pN), where an error estimate
    // ended in this step; whether it was one of an error estimate's.
    std::optional<double> estimated_error_pN;
    bool is_estimating = false;
    // The metric of everything at the last choice, and of what was not chosen: weighted squares of
    // accelerations.
    double total = 0, neglected = 0;
    bool is_chosen = false;   // joints were chosen in this step
    bool is_renewed = false;  // everything was summed anew
    // Of second order: the way of the hand since the point of linearisation, Å, and energy that a
    // renewal's relaxation set free, kcal/mol.
    std::optional<double> model_age;
    double released = 0;
    std::uint32_t snapped_atom = 0;  // that this moved farthest
    bool is_finite = true;           // else all is where the last step left it
};

// What the last step found. A step that is not finite has moved nothing.
struct StepReport {
    std::vector<HandMove> moves;             // of each hand
    std::optional<RelaxStepReport> relaxed;  // what moved by itself
    bool finite = true;
    double took_us = 0;  // wall time
};

}  // namespace palpa
