// Resources: data that a world has once.
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
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct Connectivity;
struct ForceField;
struct Topology;
class World;

// The scene as it was loaded; only loading it again reads it.
struct SceneFile {
    std::shared_ptr<const SceneDescription> scene;
};

// The position of each field of the scene in its file, by full key, for messages.
struct ScenePlaces {
    std::filesystem::path file;
    std::map<std::string, TextPlace, std::less<>> places;

    TextPlace place_of(std::string_view key) const {
        const auto found = places.find(key);
        return found == places.end() ? TextPlace{file.string()} : found->second;
    }
};

// The force field of all molecules, also of those that edits add.
struct ForceFieldInUse {
    ForceFieldDescription description;
    std::shared_ptr<const ForceField> force_field;
    std::vector<std::string> structural_waters;  // names of molecules of such waters
};

// The settings that the mechanics of mobile molecules are built with.
struct MechanicsSettings {
    JointsDescription joints;  // `around` names a molecule in any case
    StaticsDescription statics;
};

// The settings of grips that edits make, and where hands began.
struct GrabSettings {
    std::string measured_from;                 // name of a molecule, see GrabDescription
    double spring_kcal_per_mol_angstrom2 = 0;  // stiffness of a hand's spring
    std::vector<Vec3> start_offsets;           // Å, start of each hand from its place at rest
};

// Bonded terms of all molecules in the order of the table; empty until something mobile needs them.
struct BondedTerms {
    std::shared_ptr<const Connectivity> connectivity;
    std::shared_ptr<const Topology> topology;
};

// Further resources: the AtomTable, whose positions every step writes; the TorsionState, without
// atoms if nothing is mobile; and a ClientPull while clients apply forces.

// Identifies the set of atoms, molecules and bonds. Copies of a world share it; adding or removing
// replaces it by a new one that equals no other.
struct AtomEdition {
    std::shared_ptr<const int> mark;

    friend bool operator==(const AtomEdition&, const AtomEdition&) = default;
};

// Interactions of atoms beyond the columns of the table.
struct Interactions {
    double coulomb_constant = 0;                    // kcal Å/mol/e^2; over eps with smooth ends
    std::vector<ReplacedPair> replaced_pairs;       // for types of the table
    std::optional<SmoothEnds> smooth;               // with implicit solvent
    PairPrecision precision = PairPrecision::Fast;  // precision of steps, see fast_field_on_held
};

// The coupling between hands and molecules.
struct Coupling {
    CouplingLaws laws;
    bool is_guarded = false;               // the servo moves the molecule
    std::size_t pairs_per_tick = 130'000;  // pairs that a servo tick has time for
    CouplingDescription description;       // the scene's, as edits have changed it
};

struct Clock {
    double period_s = 0;  // declared period of a step
    std::uint64_t steps = 0;
    std::uint64_t resets = 0;  // number of resets by edits; the step counter continues
};

// The atoms of the table that a model contains.
struct ModelAtoms {
    // Table index of each atom of the model, ascending. Empty: the model has all atoms with the
    // same indices.
    std::vector<std::uint32_t> in_table;

    std::uint32_t number_in_table(std::uint32_t in_model) const noexcept {
        return in_table.empty() ? in_model : in_table[in_model];
    }
    // Nothing if the model does not contain the atom.
    std::optional<std::uint32_t> in_model(std::uint32_t number_in_table) const noexcept;
};

// Writes the positions of mobile atoms to the table.
void put_in_table(const TorsionModel& model, const ModelAtoms& atoms,
                  const std::vector<Vec3>& positions, std::vector<Vec3>& table);

// The mobile molecules as torsion bodies; no atoms if there are none. Copies of a world share it.
struct Mechanics {
    std::shared_ptr<const TorsionModel> model = std::make_shared<const TorsionModel>();
    std::shared_ptr<const ModelAtoms> atoms = std::make_shared<const ModelAtoms>();
};

// The entity of each spring in the TorsionState, ascending.
struct GatheredSprings {
    std::vector<Entity> entities;
};

// How mobile parts are relaxed.
struct Solver {
    RelaxSettings settings;  // for every step
    QuasiStatics statics;

    std::size_t count_bytes() const noexcept;
};

struct Ball {
    Vec3 centre;  // Å
    double radius;
};

// The part of an AdaptiveState that cannot be rebuilt from the world.
struct AdaptivePlan {
    AdaptiveSettings settings;
    std::optional<TimeBudget> budget;
    // If the scene sets an accuracy: the controller of the work.
    std::optional<AccuracyController> accuracy;
    // Before a step: the force rendered to the first hand at its present pose, kcal/mol/Å; nothing:
    // use the step's own result.
    std::optional<Vec3> rendered;
    std::size_t choose_every = 0;  // steps between selections, from the scene
    // Weight of each joint by what it moves; empty: all equal. Then whether parts near hands have
    // more weight, and the regions found last.
    std::vector<double> mobility_weights;
    bool weighs_hand_proximity = false;
    std::vector<Ball> near_to;  // region around each hand
};

// If not everything is active at a time, or the scene sets an accuracy.
struct AdaptiveState : AdaptivePlan {
    AdaptiveStatics statics;
    std::size_t copied = 0;     // number of cluster rebuilds at the last full copy of positions
    bool lacks_caches = false;  // all of `statics` but its step length, guides and counters

    AdaptiveState without_caches() const;
    std::size_t count_bytes() const noexcept;
};

// If steps do not relax everything: the difference between the force on the first hand and that of
// complete relaxation, estimated on a copy now and then.
struct ErrorEstimate {
    SecondOrderSettings settings;
    HeldParts held;
    std::optional<RenewalMemory> memory;  // set by the first estimate
    std::size_t steps = 0;                // step of the simulation
    std::optional<double> last_pN;
    Vec3 felt_pN = Vec3::Zero();  // force at that time
    std::size_t evaluations = 0;  // number of evaluations used

    ErrorEstimate without_caches() const;
};

// A renewal that releases more energy than this (kcal/mol) is a snap: a minimum had vanished.
inline constexpr double least_snap = 1;

// The part of a SecondOrder that cannot be rebuilt from the world.
struct SecondOrderPlan {
    SecondOrderSettings settings;
    std::vector<Entity> hands;  // in the order of the statics

    // Delay until a pending renewal is used: a declared time, or until the step's input says so.
    // Steps use the old model meanwhile.
    std::optional<double> delay_s;
    std::uint64_t due = 0;  // step of the clock, with a declared delay

    // In real time without a declared delay: as many model evaluations per step as fit into most of
    // the period, from the wall time of the last ones.
    std::size_t most_evaluations = 0;
    double evaluation_us = 0;

    // The last snap: energy released by the renewals (kcal/mol), the atom that moved farthest, and
    // the step of the clock.
    struct Snap {
        std::uint32_t atom = 0;
        double released = 0;
        std::uint64_t step = 0;
    };
    std::optional<Snap> snap;
};

// State of second-order steps.
struct SecondOrder : SecondOrderPlan {
    SecondOrderStatics statics;
    bool lacks_caches = false;  // all of `statics` but what hands hold

    // Another thread may be making the pending renewal meanwhile.
    SecondOrder without_caches() const;
    std::size_t count_bytes() const noexcept;
};

// How the scene was relaxed at loading.
struct StartReport {
    std::optional<RelaxReport> rigid;                // the held molecule, if rigid in space
    std::optional<JointRelaxReport> joints_at_rest;  // all mobile parts
    std::size_t joints = 0;                          // total number
    std::size_t joints_held = 0;  // joints that only the region keeps from turning
};

// The motion of a hand in a step.
struct HandMove {
    double angstrom = 0;  // displacement of what it holds
    // A_d used by the step; nothing if the servo applied it.
    std::optional<double> displacement_gain;
};

struct [[nodiscard]] RelaxStepReport {
    double hand_work = 0;      // kcal/mol, energy increase by moving what hands hold
    double energy_change = 0;  // kcal/mol, by relaxation: above 0 only by rounding
    double largest_move = 0;   // largest displacement of an atom, Å
    std::size_t evaluations = 0;
    std::size_t active = 0;  // active degrees of freedom
    std::size_t steps = 0;   // relaxation steps
    // Error of the force on the hand against that with all joints (pN), if an error estimate ended
    // in this step.
    std::optional<double> estimated_error_pN;
    bool is_estimating = false;
    // The metric of all degrees of freedom at the last selection and of those not selected:
    // weighted squares of accelerations.
    double total = 0, neglected = 0;
    bool is_chosen = false;   // joints were selected in this step
    bool is_renewed = false;  // all sums were recomputed
    // For second order: displacement of the hand since the point of linearisation, Å, and energy
    // released by a renewal's relaxation, kcal/mol.
    std::optional<double> model_age;
    double released = 0;
    std::uint32_t snapped_atom = 0;  // atom that moved farthest by it
    bool is_finite = true;           // if false, everything is as after the last step
};

// Results of the last step. A step that is not finite has moved nothing.
struct StepReport {
    std::vector<HandMove> moves;             // one per hand
    std::optional<RelaxStepReport> relaxed;  // motion of mobile parts
    bool finite = true;
    double took_us = 0;  // wall time
};

// Rebuilds the caches of the mechanics after a transaction that was rolled back.
void restore_caches(World& world) noexcept;

}  // namespace palpa
