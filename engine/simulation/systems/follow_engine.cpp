#include "simulation/systems/follow_engine.h"

#include "core/repeatable.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/solver.h"
#include "simulation/systems/gather_springs.h"
#include "simulation/systems/publish_contact.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa {
namespace {

// The farthest way between two frames; atoms that move farther have gone into another image.
constexpr double farthest_move = 8;  // Å
// The farthest place at which atoms are held.
constexpr double farthest_place = 1e5;  // Å

// Starts the hold again without a stretch of its spring; the servo puts the hand's end there.
void restart_hold(World& world, Entity hand, EngineHold& hold) {
    Grip& grip = *world.write<Grip>(hand);
    hold.smoothed = hold.middle;
    hold.is_live = true;
    grip.pose.place_angstrom = hold.middle - grip.anchor;
    world.write<Spring>(hand)->place = hold.middle;
    gather_springs(world, {});
    ++world.write<Contact>(hand)->sent.model.grip_number;
}

void follow_atoms(World& world, const RemoteEngine& engine, Entity hand, bool is_live) {
    EngineHold& hold = *world.write<EngineHold>(hand);
    const Vec3 middle = find_middle(world.resource<AtomTable>(), hold);
    const bool has_jumped = (middle - hold.middle).norm() > farthest_move;
    hold.middle = middle;
    if (!is_live || middle.cwiseAbs().maxCoeff() > farthest_place) {
        hold.is_live = false;
    } else if (!hold.is_live || has_jumped) {
        restart_hold(world, hand, hold);
    } else {
        const double constant_s = 1e-3 * engine.settings.smoothing_ms;
        const double share =
            constant_s > 0 ? 1 - repeatable::exp(-world.resource<Clock>().period_s / constant_s)
                           : 1;
        hold.smoothed += share * (middle - hold.smoothed);
    }
}

struct AtomForce {
    std::int32_t atom;  // of the engine
    Vec3 force;         // kcal/mol/Å
};

// Two hands may hold the same atoms.
std::vector<AtomForce> list_forces(const World& world, const RemoteEngine& engine) {
    std::vector<AtomForce> all, forces;
    world.each<EngineHold>([&](Entity hand, const EngineHold& hold) {
        if (!hold.is_live) return;
        const Vec3 force = -engine.settings.force_scale * find_engine_spring(world, hand).force;
        for (std::size_t i = 0; i < hold.atoms.size(); ++i) {
            const std::int32_t atom = engine.atoms->in_engine[hold.atoms[i]];
            if (atom >= 0) all.push_back({atom, hold.shares[i] * force});
        }
    });
    std::ranges::stable_sort(all, {}, &AtomForce::atom);
    for (const AtomForce& next : all) {
        if (!forces.empty() && forces.back().atom == next.atom) {
            forces.back().force += next.force;
        } else {
            forces.push_back(next);
        }
    }
    return forces;
}

// Sends the forces; if the engine cannot have them, the hand feels nothing either.
void send_forces(World& world, RemoteEngine& engine) {
    std::vector<std::int32_t> atoms;
    std::vector<Vec3> forces;
    for (const AtomForce& next : list_forces(world, engine)) {
        atoms.push_back(next.atom);
        forces.push_back(next.force);
    }
    engine.refusal.clear();
    if (atoms.empty()) return engine.client->release_atoms();
    engine.refusal = engine.client->pull(atoms, forces);
    if (engine.refusal.empty()) return;
    for (const Entity hand : find_hands(world)) {
        if (EngineHold* const hold = world.write<EngineHold>(hand)) hold->is_live = false;
    }
}

}  // namespace

void follow_engine(World& world, RemoteEngine& engine) {
    take_newest_frame(world, engine);
    const bool is_live = engine.client->state() == ImdState::Connected;
    for (const Entity hand : find_hands(world)) {
        if (world.find<EngineHold>(hand)) follow_atoms(world, engine, hand, is_live);
    }
    if (is_live) send_forces(world, engine);
}

void begin_with_engine(World& world) {
    RemoteEngine& engine = *write_solver<RemoteEngine>(world);
    await_engine(world, engine);
    follow_engine(world, engine);
    for (const Entity hand : find_hands(world)) {
        if (world.find<EngineHold>(hand)) update_contact(world, hand, {});
    }
}

}  // namespace palpa
