// The state of a running scene, and how it is made.
#pragma once
#include "charmm/topology.h"
#include "core/stage.h"
#include "ecs/entity.h"
#include "ecs/world.h"
#include "field/pair_field.h"
#include "haptics/exchange.h"
#include "haptics/gains.h"
#include "math/vec.h"
#include "molecule/atoms.h"
#include "molecule/connectivity.h"
#include "scene/description.h"
#include "simulation/flexible.h"
#include "simulation/relax.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// Atoms of the environment near to the molecule in the hand, by number, rising.
struct NearAtoms {
    std::vector<std::uint32_t> atoms;  // empty: not chosen yet
    Vec3 place = Vec3::Zero();         // of the molecule when they were chosen
    std::size_t steps = 0;             // since
    std::size_t most = 0;              // that were asked for
};

// Owned by one thread. The grabbed molecule's atoms stand first in the table, all others, its
// environment, behind them.
struct Simulation {
    explicit Simulation(CouplingLaws coupling_laws) : laws(coupling_laws) {}

    // written on loading
    CouplingLaws laws;
    double coulomb_constant = 0;               // kcal Å/mol/e^2
    std::vector<ReplacedPair> replaced_pairs;  // of types in the table
    double period_s = 0;                       // declared
    bool is_guarded = false;                   // the servo moves the molecule
    std::size_t pairs_per_tick = 130'000;      // that it has time for
    Vec3 anchor = Vec3::Zero();          // Å, where places of the grabbed molecule are told from
    std::vector<Vec3> grabbed_shape;     // Å, the grabbed molecule's atoms from its reference atom,
                                         // where it is rigid
    std::optional<RelaxReport> relaxed;  // how the rigid grabbed molecule came to rest, if it did
    Entity hand;                         // has a Grab

    // written by every step
    World world;
    AtomTable atoms;                   // positions only
    std::optional<Flexible> flexible;  // where something moves by itself
    NearAtoms near;
    Touch touch;  // the last answer to the hand
};

// The laws that a scene's mode asks for.
CouplingLaws build_coupling_laws(const CouplingDescription& coupling);

// Whether there are such laws: eq. 2 cannot be calibrated to any numbers.
bool can_build_laws(const CouplingDescription& coupling);

// Makes the scene's coupling that of a simulation.
void set_coupling(const CouplingDescription& coupling, Simulation& simulation);

// Reads everything the scene names, relaxes a grabbed molecule that moves in space as a rigid body,
// until less than 20 pN pull at it, or everything that moves by itself as the scene's [statics]
// say, and puts the grabbed molecule at its start. `on_stage` hears what takes long. Throws
// LoadError with the place of what is wrong.
Simulation load_simulation(const SceneDescription& scene, const StageFunction& on_stage = {});

// What a scene's molecules are, in the order of the atom table that load_simulation makes, and
// where its files have them.
struct SceneSystem {
    Connectivity connectivity;
    Topology topology;
    std::vector<Vec3> positions;  // Å
};

// Without anything moved, held or relaxed. Throws LoadError as load_simulation does.
SceneSystem load_system(const SceneDescription& scene);

// By mass; of massless atoms the first's place.
Vec3 centre_of_mass(const AtomTable& atoms, AtomRange range) noexcept;

// The grabbed molecule and all other atoms, as the pair kernel wants them.
FieldPoints grabbed_points(const Simulation& simulation) noexcept;
FieldPoints environment_points(const Simulation& simulation) noexcept;
PairRule pair_rule(const Simulation& simulation) noexcept;

}  // namespace palpa
