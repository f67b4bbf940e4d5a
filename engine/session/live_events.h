// The events and ticks of a live session. Played again in the same order, they give the same bits.
#pragma once
#include "haptics/device.h"
#include "haptics/servo.h"
#include "session/commands.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace palpa {

// What the simulation has to know of the device of a hand.
struct HandDevice {
    DeviceSpec spec;
    bool stands_still = false;  // while the session is paused; true for an emulated device
};

// ---- of the simulation -------------------------------------------------------------------------

// Publishes the result of the last step to the servos.
struct PublishEvent {};
struct StepEvent {
    std::optional<double> took_us{};  // wall time of the step, set when a journal is played
    bool adopts_renewal = false;      // the step begins with the pending second-order renewal
};
// Holds the simulation: hands move nothing and feel nothing meanwhile.
struct HoldEvent {};
// A command of a person. ViewSettings belong to the window and PlaybackOrder is not recorded, so
// neither occurs here. `settles`: hands feel nothing yet. `is_long`: an edit that another thread
// makes while the world stands still.
struct CommandEvent {
    Command command;
    bool settles = false;
    bool is_long = false;
};
// Replaces the world by the one that a long edit has built.
struct AdoptEvent {
    bool settles = false;
};
// Changes the device of a hand; all servos restart.
struct DeviceEvent {
    std::size_t slot = 0;
    HandDevice device;
};
using LiveEvent =
    std::variant<PublishEvent, StepEvent, HoldEvent, CommandEvent, DeviceEvent, AdoptEvent>;

// An event with the number of the poses of all hands that it began from; 0: no pose had arrived.
struct PlayedEvent {
    LiveEvent event;
    std::vector<std::uint64_t> poses;
    // Contents of the edit's files (list_files), for a recording; nothing for a file that could not
    // be read.
    std::vector<std::optional<std::string>> files{};
};

// ---- of the servos -----------------------------------------------------------------------------

// The orders for the servo of a hand.
struct ServoOrder {
    ServoSettings settings;
    std::uint32_t restarts = 0;  // a change of this number ends a latched stop
    bool is_paused = false;      // only on devices that stand still
    std::uint64_t number = 0;    // counts the orders sent to this hand's servo
};

// One tick of one hand: its result, and its inputs besides the reading (`tick.reading`).
// `tick.contact.number` names the contact model in force.
struct LiveTick {
    ServoTick tick;
    double now_s = 0;         // the servos' clock
    std::uint64_t order = 0;  // number of the order in force
    bool is_ending = false;   // the force fades
    bool is_fresh = false;    // the first tick after a servo's restart
};

}  // namespace palpa
