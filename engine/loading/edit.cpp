#include "loading/edit.h"

#include "loading/named_parts.h"
#include "simulation/components.h"
#include "simulation/playback.h"
#include "simulation/resources.h"
#include "simulation/solver.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// Gives another world, which takes this one's place, the clock, and hands where their devices are;
// they take hold of what they hold there anew.
void keep_clock_and_devices(const World& world, World& other) {
    world.each<Hand>([&](Entity entity, const Hand& hand) {
        if (Hand* const held = other.write<Hand>(entity)) *held = hand;
        const Contact* const now = world.find<Contact>(entity);
        Contact* const then = other.write<Contact>(entity);
        if (now && then) then->sent.model.grip_number = now->sent.model.grip_number + 1;
    });
    other.write<Clock>() = world.resource<Clock>();
    carry_playback(world, other);
    carry_engine(world, other);
}

// Refuses what needs atoms that edits may place.
void check_engine_allows(const World& world, const EditAction& action) {
    if (places_atoms(world) || kind_of(action).with_engine) return;
    refuse(
        fmt::format("a remote engine moves the atoms of this scene, so '{}' is not possible; "
                    "expected {}",
                    kind_of(action).key, fmt::join(list_edits_with_engine(), ", ")));
}

}  // namespace

World make_edit(const World& world, const EditDescription& edit) {
    World changed = world;
    const auto apply = [&](const auto& action) {
        if constexpr (requires { action.apply(changed, edit.hand); })
            action.apply(changed, edit.hand);
    };
    name_place(edit.place, [&] {
        check_engine_allows(world, edit.action);
        std::visit(apply, edit.action);
    });
    return changed;
}

World continue_with(const World& world, World other) {
    keep_clock_and_devices(world, other);
    restore_caches(other);
    return other;
}

}  // namespace palpa
