// Molecules of a scene that move by themselves: joints that turn, bases that are free.
#pragma once
#include "charmm/topology.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"
#include "scene/description.h"
#include "statics/relax_joints.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace palpa {

// A scene's molecule in the atom table.
struct FlexiblePart {
    const MoleculeDescription* description;
    AtomRange atoms;
    std::uint32_t reference_atom;
};

// Owned by the simulation; atoms are those of its table.
struct Flexible {
    TorsionModel model;
    TorsionState state;
    QuasiStatics statics;
    TorsionState safe;            // where the last step left it
    RelaxSettings settings;       // of every step
    std::uint32_t grabbed = 0;    // the molecule of the model whose base the hand moves
    JointRelaxReport relaxed;     // on loading
    std::size_t joints = 0;       // in all
    std::size_t joints_held = 0;  // that the rules would turn, were it not for the region
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
    bool is_finite = true;  // else all is where the last step left it
};

// As many steps towards rest as the scene says.
SettleReport step_flexible(Flexible& flexible);

}  // namespace palpa
