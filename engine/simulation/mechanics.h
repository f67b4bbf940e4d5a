// The mechanics of mobile molecules: which joints turn, which bases are free, what springs pull.
#pragma once
#include "ecs/world.h"
#include "scene/description.h"
#include "simulation/resources.h"
#include "statics/relax_joints.h"
#include "statics/torsion_model.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace palpa {

// Whether anything is mobile: joints that may turn, a base that is free or turns, something on a
// spring.
bool needs_mechanics(const World& world);

// What all molecules are together. Reads or generates what was not asked for before. Throws
// LoadError, also where molecules are bonded to each other or are the same atoms.
const BondedTerms& bonded_terms(World& world);

// Mechanics anew, or none, from what molecules may do and hands hold, where everything is: nothing
// is remembered of those before. Throws LoadError naming joints of the scene that are not there,
// and molecules that a hand cannot hold; then the world is of no use.
void rebuild_mechanics(World& world);

// Whether an atom has gone so far that it could soon feel others that a region's mechanics do not
// have (simulation/region.h).
bool has_left_region(const World& world) noexcept;

// Mechanics anew of the region around where hands now hold something. Where that is too large the
// old ones stay.
void renew_region(World& world) noexcept;

// Called while molecules come to rest; where it returns false they stay as they are.
using RelaxProgressFunction = std::function<bool(const RelaxProgress&)>;

// The same for a world just loaded, with everything at rest, what hands hold too; StartReport says
// how it got there.
void relax_and_build_mechanics(World& world, const RelaxProgressFunction& on_relax = {});

// What a hand has hold of: a molecule of the torsion model, whose base it moves, or the spring by
// which it pulls.
struct HeldPart {
    std::uint32_t base = 0;
    std::optional<Spring> spring = {};
};

// A world of a model that is at rest where its reference is, as the scene's statics move it, and of
// one hand, which moves a base or pulls at a spring from where that is; nothing else: for
// measurements.
World build_mechanics_world(const SceneDescription& scene, TorsionModel model,
                            const HeldPart& held);

// What the first hand holds.
HeldPart held_part(const World& world);

// For measurements outside of a step. The first hand moves what it holds of them, wherever it is;
// what is mobile settles as in one step.
void move_held(World& world, const Vec3& by);
RelaxStepReport relax_step(World& world);
// Starts from another state, with nothing remembered.
void put_state(World& world, const TorsionState& state);

// Takes what the state is now as the start: forces, and where a step that fails goes back to.
void start_mechanics(World& world);

}  // namespace palpa
