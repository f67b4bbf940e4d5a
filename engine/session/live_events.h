// What happens in a live session, as its simulation and its servos are given it: the same events
// and ticks, in the same order, give the same bits.
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

// A device in a hand, as far as the simulation has to know it.
struct HandDevice {
    DeviceSpec spec;
    bool stands_still = false;  // while the session is paused: an emulated one
};

// ---- of the simulation -------------------------------------------------------------------------

// What the last step found goes to the servos.
struct PublishEvent {};
struct StepEvent {
    std::optional<double> took_us{};  // wall time, where it is played again
    bool adopts_renewal = false;      // begins with the pending renewal of second order
};
// Whatever hands do meanwhile moves nothing, and they feel nothing.
struct HoldEvent {};
// All but ViewSettings, which are the window's business, and PlaybackOrder: what plays a trajectory
// is not recorded. `settles`: hands are not to be felt yet.
// `is_long`: an edit, which another thread makes while the world stands still.
struct CommandEvent {
    Command command;
    bool settles = false;
    bool is_long = false;
};
// What a long edit made takes the world's place.
struct AdoptEvent {
    bool settles = false;
};
// Another device in a hand; all servos begin anew.
struct DeviceEvent {
    std::size_t slot = 0;
    HandDevice device;
};
using LiveEvent =
    std::variant<PublishEvent, StepEvent, HoldEvent, CommandEvent, DeviceEvent, AdoptEvent>;

// With the poses of all hands from which it began, by number; 0: none came yet.
struct PlayedEvent {
    LiveEvent event;
    std::vector<std::uint64_t> poses;
    // What an edit's files (list_files) held, as far as they could be read, for who keeps them.
    std::vector<std::optional<std::string>> files{};
};

// ---- of the servos -----------------------------------------------------------------------------

// What the servo of a hand is to do from now on.
struct ServoOrder {
    ServoSettings settings;
    std::uint32_t restarts = 0;  // another number ends a latched stop
    bool is_paused = false;      // on devices that stand still
    std::uint64_t number = 0;    // of those that this hand's servo was sent
};

// One tick of one hand: what it did, and besides its reading (`tick.reading`) what it was given.
// The contact model in force is that of `tick.contact.number`.
struct LiveTick {
    ServoTick tick;
    double now_s = 0;         // the servos' clock
    std::uint64_t order = 0;  // in force
    bool is_ending = false;   // the force fades
    bool is_fresh = false;    // the first of a servo that begins anew
};

}  // namespace palpa
