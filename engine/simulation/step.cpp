#include "simulation/step.h"

#include "simulation/components.h"
#include "simulation/mechanics.h"
#include "simulation/playback.h"
#include "simulation/solver.h"
#include "simulation/systems/follow_hands.h"
#include "simulation/systems/gather_springs.h"
#include "simulation/systems/measure.h"
#include "simulation/systems/play_trajectory.h"
#include "simulation/systems/publish_contact.h"
#include "simulation/systems/pull_by_clients.h"
#include "simulation/systems/relax.h"

#include <chrono>
#include <utility>

namespace palpa {
namespace {

using System = void (*)(World&, const StepInput&);

// The step.
constexpr System systems[] = {
    play_trajectory,  // the frame that is due, where one is played
    follow_hands,     // device poses to poses of what is held, and ends of springs
    pull_by_clients,  // forces of clients to ends of springs
    gather_springs,   // springs of all owners to the mechanics
    relax,            // joints and bases towards rest, or all atoms to where an engine has them
    publish_contact,  // a contact model for every hand
    measure,          // what can be read
};

// Returns the world to what it was before the step, but for what tells of the failure: the report,
// and a contact force that is not finite, which stops the servo. A trajectory goes on.
void go_back(World& world) {
    const World failed = world;
    world.roll_back();
    restore_caches(world);
    world.set_resource(failed.resource<StepReport>());
    carry_playback(failed, world);
    failed.each<Contact>([&](Entity hand, const Contact& contact) {
        const Vec3& force = contact.sent.model.force_newton;
        if (force.allFinite() || !world.find<Contact>(hand)) return;
        world.write<Contact>(hand)->sent.model.force_newton = force;
    });
}

}  // namespace

const StepReport& step_world(World& world, const StepInput& input) noexcept {
    const auto begin = std::chrono::steady_clock::now();
    if (has_left_region(world)) {
        if (input.await_renewal) input.await_renewal();
        renew_region(world);
    }
    world.begin();
    world.set_resource(StepReport{});
    before_step(world, input);
    for (const System system : systems) {
        system(world, input);
        if (!world.resource<StepReport>().finite) break;
    }
    if (world.resource<StepReport>().finite) {
        world.commit();
    } else {
        // Another thread may be filling caches.
        if (input.await_renewal) input.await_renewal();
        go_back(world);
    }
    after_step(world);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
    world.write<StepReport>().took_us = input.took_us.value_or(took.count());
    note_time(world);
    return world.resource<StepReport>();
}

const StepReport& step_world(World& world, const HandPose& hand,
                             const ContactModel& felt) noexcept {
    return step_world(world, {{&hand, 1}, {&felt, 1}});
}

}  // namespace palpa
