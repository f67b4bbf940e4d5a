// Resources: data that a world has once.
#pragma once
#include "ecs/entity.h"
#include "field/pair_field.h"
#include "haptics/gains.h"
#include "math/vec.h"
#include "molecule/atoms.h"
#include "scene/description.h"
#include "statics/relax_joints.h"
#include "statics/relax_rigid.h"
#include "statics/torsion_state.h"

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
    // The largest error of the force on a hand against that with all joints (pN), if an error
    // estimate ended in this step.
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

}  // namespace palpa
