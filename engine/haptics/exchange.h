// The two mailboxes between servo and simulation: the hand's pose inward, the contact model
// outward. They close the loop from hand to molecule to hand.
#pragma once
#include "core/mailbox.h"
#include "haptics/local_field.h"
#include "math/vec.h"

#include <cstdint>
#include <optional>

namespace palpa {

// Sent by the servo to the simulation in every tick.
struct HandPose {
    double time_s = 0;
    // Total travel of the handle, m, without travel while the clutch was pressed, or that the
    // thermal limit excluded.
    Vec3 travel_m = Vec3::Zero();
    Quat turn = Quat::Identity();  // total turn of the handle
    // Pose of the molecule in guarded coupling. In the other modes it is unset, and the simulation
    // moves the molecule by travel and turn.
    std::optional<MoleculePose> molecule = {};
    std::uint32_t grip_number = 0;  // grip number of the contact model in use
    std::uint64_t number = 0;       // number of the servo tick, from 1
    bool is_clutched = false;       // the handle moves nothing
};

// The result of a simulation step. It is one step old when it is felt: the paper's z^-1.
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
