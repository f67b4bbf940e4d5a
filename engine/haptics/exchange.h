// The one place where servo and simulation meet: two mailboxes, the hand's pose inward and the
// contact model outward. Here the loop from hand to molecule to hand is closed.
#pragma once
#include "core/mailbox.h"
#include "haptics/local_field.h"
#include "math/vec.h"

#include <cstdint>
#include <optional>

namespace palpa {

// What the servo sends to the simulation, every tick.
struct HandPose {
    double time_s = 0;
    // Handle travel so far, but for what was travelled clutched, or under motors that were too warm
    // to play the whole force.
    Vec3 travel_m = Vec3::Zero();
    Quat turn = Quat::Identity();  // and handle turn
    // Where guarded coupling has put the molecule. Without it the simulation moves the molecule by
    // travel and turn.
    std::optional<MoleculePose> molecule = {};
    std::uint32_t start = 0;   // of the contact model by which it did
    std::uint64_t number = 0;  // of the servo's ticks, from 1 on
};

// The simulation's answer. One simulation step old when it is felt: the paper's z^-1.
struct LocalContactModel {
    ContactModel model;
    LocalField field;

    LocalContactModel() = default;
    LocalContactModel(const ContactModel& without_field)
        : model(without_field) {}  // NOLINT: as good as one
};

struct Exchange {
    Mailbox<HandPose> hand;
    Mailbox<LocalContactModel> contact;
};

}  // namespace palpa
