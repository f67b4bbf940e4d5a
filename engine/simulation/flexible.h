// Molecules of a scene that move by themselves: joints that turn, bases that are free.
#pragma once
#include "charmm/topology.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"
#include "scene/description.h"
#include "simulation/exactness.h"
#include "statics/adaptive_step.h"
#include "statics/relax_joints.h"
#include "statics/time_budget.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// A scene's molecule in the atom table.
struct FlexiblePart {
    const MoleculeDescription* description;
    AtomRange atoms;
    std::uint32_t reference_atom;
};

struct Ball {
    Vec3 centre;  // Å
    double radius;
};

// Of a scene in which not everything is active at a time, or that says how exact it must be.
struct FewActive {
    AdaptiveSettings settings;
    AdaptiveStatics statics;
    std::optional<TimeBudget> budget;
    // Where the scene says how exact forces must be, and what finds out.
    std::optional<Exactness> exactness;
    Audit audit;
    // The caller's, before a step: what the hand was told where it now is, kcal/mol/Å; nothing:
    // what the step itself tells.
    std::optional<Vec3> told;
    std::size_t choose_every = 0;  // steps, as the scene says
    // How much each joint counts for what it moves; empty where all do alike. And whether what is
    // near to the hand counts more, and around what that was found last.
    std::vector<double> lightness;
    bool is_near_hand = false;
    std::optional<Ball> near_to;
    struct {
        Vec3 shift = Vec3::Zero(), place = Vec3::Zero();  // Å, of its base, of its spring
    } held_before;           // where the last step left what is in hand
    std::size_t copied = 0;  // rebuilds of the clusters when positions were copied in full
};

// Owned by the simulation; atoms are those of its table.
struct Flexible {
    TorsionModel model;
    TorsionState state;
    QuasiStatics statics;
    TorsionState safe;                  // where the last step left it
    RelaxSettings settings;             // of every step
    std::optional<FewActive> adaptive;  // instead, where not everything is active at a time
    std::uint32_t grabbed = 0;          // the molecule of the model whose base the hand moves
    JointRelaxReport relaxed;           // on loading
    std::size_t joints = 0;             // in all
    std::size_t joints_held = 0;        // that the rules would turn, were it not for the region
};

// Called while molecules come to rest; where it returns false they stay as they are.
using RelaxProgressFunction = std::function<bool(const RelaxProgress&)>;

// Relaxes everything, the molecule in the hand too, and hands that over to the hand. `parts` in the
// order of the table, the one in the hand first. Throws LoadError naming joints and atoms of the
// scene that are not there, and molecules that the hand cannot hold.
Flexible build_flexible(const SceneDescription& scene, const Connectivity& connectivity,
                        const Topology& topology, std::span<const Vec3> positions,
                        std::span<const FlexiblePart> parts,
                        const RelaxProgressFunction& on_relax = {});

// A model that is at rest where its reference is, as the scene's statics move it. The hand moves
// the base of the molecule `grabbed`, or what the tether holds, from where that is.
Flexible build_flexible(const SceneDescription& scene, TorsionModel model, std::uint32_t grabbed,
                        std::optional<Tether> tether = {});

// Takes what the state is now as the start: forces, and where a step that fails goes back to.
void start_flexible(Flexible& flexible);

// Where the hand holds: the reference atom of a molecule that it moves, else the end of its spring.
Vec3 find_held(const Flexible& flexible) noexcept;

// Moves what the hand holds.
void move_held(Flexible& flexible, const Vec3& by) noexcept;

struct [[nodiscard]] SettleReport {
    double hand_work = 0;      // kcal/mol, by which moving what the hand holds raised the energy
    double energy_change = 0;  // kcal/mol, by coming to rest: above 0 only by rounding
    double largest_move = 0;   // of any atom, Å
    std::size_t evaluations = 0;
    std::size_t active = 0;  // degrees of freedom that could move
    std::size_t steps = 0;   // towards rest
    // How far the force on the hand was from what all joints give (pN), where an audit ended in
    // this step; whether it was one of an audit's.
    std::optional<double> audited_pN;
    bool is_audited = false;
    // The metric of everything at the last choice, and of what was not chosen: weighted squares of
    // accelerations.
    double total = 0, neglected = 0;
    bool is_chosen = false;   // joints were chosen in this step
    bool is_renewed = false;  // everything was summed anew
    bool is_finite = true;    // else all is where the last step left it
};

// As many steps towards rest as the scene says.
SettleReport step_flexible(Flexible& flexible);

// How long the whole step took that the report is of; what a time budget goes by.
void note_time(Flexible& flexible, const SettleReport& report, double took_us) noexcept;

// Degrees of freedom that can move now.
std::size_t find_active_freedom(const Flexible& flexible) noexcept;

// Force and torque about the origin on the molecule that the hand moves, from all others.
Vec6 find_pull_on_held(const Flexible& flexible) noexcept;

// What pulls at the hand, kcal/mol/Å: that on the molecule it moves, or its spring.
Vec3 find_force_on_held(const Flexible& flexible) noexcept;

// The places of atoms in the scene's table, those that have changed since `positions` were written
// the last time.
void copy_positions(Flexible& flexible, std::vector<Vec3>& positions);

}  // namespace palpa
