#include "simulation/step.h"

#include "simulation/components.h"
#include "simulation/held.h"
#include "simulation/mechanics.h"
#include "simulation/observe.h"
#include "simulation/systems/choose_active.h"
#include "simulation/systems/follow_engine.h"
#include "simulation/systems/follow_hands.h"
#include "simulation/systems/gather_springs.h"
#include "simulation/systems/measure.h"
#include "simulation/systems/play_trajectory.h"
#include "simulation/systems/publish_contact.h"
#include "simulation/systems/pull_by_clients.h"
#include "simulation/systems/relax.h"

#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

namespace palpa {
namespace {

using System = void (*)(World&, const StepInput&);

// The step.
constexpr System systems[] = {
    play_trajectory,  // the frame that is due, where one is played
    follow_hands,     // device poses to poses of what is held, and ends of springs
    pull_by_clients,  // forces of clients to ends of springs
    gather_springs,   // springs of all owners to the mechanics
    choose_active,    // which joints and bases move
    relax,            // these towards rest
    follow_engine,    // or all atoms where a remote engine has them
    publish_contact,  // a contact model for every hand
    measure,          // what can be read
};

// What a step may change, as it was.
struct Before {
    std::vector<MoleculePose> grips;
    std::vector<std::pair<Entity, Vec3>> ends;
    MobileCoordinates mobile;
};

Before remember(const World& world) {
    Before before{{}, {}, save_mobile(world)};
    world.each<Spring>([&](Entity entity, const Spring& spring) {
        before.ends.emplace_back(entity, spring.place);
    });
    world.each<Grip>([&](Entity, const Grip& grip) { before.grips.push_back(grip.pose); });
    return before;
}

void go_back(const Before& before, World& world) {
    restore_mobile(before.mobile, world);
    for (const auto& [entity, place] : before.ends) {
        if (Spring* const spring = world.find<Spring>(entity)) spring->place = place;
    }
    gather_springs(world, {});
    std::size_t next = 0;
    world.each<Grip>([&](Entity hand, Grip& grip) {
        const MoleculePose& pose = before.grips[next++];
        if (is_mobile(world, hand)) {
            grip.pose = pose;  // its place is one of those coordinates
        } else {
            place_held(world, hand, pose);
        }
    });
}

}  // namespace

const StepReport& step_world(World& world, const StepInput& input) noexcept {
    const auto begin = std::chrono::steady_clock::now();
    if (has_left_region(world)) {
        if (input.await_renewal) input.await_renewal();
        renew_region(world);
    }
    StepReport& report = world.resource<StepReport>();
    report = {};
    const Before before = remember(world);
    note_rendered_force(world, input);
    for (const System system : systems) {
        system(world, input);
        if (report.finite) continue;
        if (input.await_renewal) input.await_renewal();
        if (system != follow_hands) go_back(before, world);  // which has moved nothing then
        break;
    }
    estimate_error(world);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
    report.took_us = input.took_us.value_or(took.count());
    note_time(world);
    return report;
}

const StepReport& step_world(World& world, const HandPose& hand,
                             const ContactModel& felt) noexcept {
    return step_world(world, {{&hand, 1}, {&felt, 1}});
}

}  // namespace palpa
