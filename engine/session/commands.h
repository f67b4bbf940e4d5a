// What may be asked of a running scene, and what it tells of itself.
#pragma once
#include "haptics/exchange.h"
#include "scene/description.h"
#include "simulation/exactness.h"
#include "view/build_frame.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace palpa {

// What a person may change while a scene runs.
struct LiveSettings {
    CouplingDescription coupling;
    double period_ms = 1;

    friend bool operator==(const LiveSettings&, const LiveSettings&) = default;
};

// Commands are taken between two steps, in the order in which they were sent.
struct Pause {
    bool paused = true;  // while it lasts nothing moves, and the hand feels nothing
};
struct StepOnce {};  // and pause
// Load the scene again; the settings stay.
struct Reset {
    // On a line, Å: where it is to start from now on, if not where it did.
    std::optional<double> start_angstrom{};
};
using Command = std::variant<LiveSettings, ViewSettings, Pause, StepOnce, Reset>;

// What a running scene tells, all of one moment between two steps.
struct Readout {
    TouchModel touch;
    std::uint64_t steps = 0;
    double step_ms = 0;  // wall time of the last step
    // Where the scene says how exact forces must be: what nine of ten of the last audits found at
    // most, nothing before the first, and what a step uses for it.
    std::optional<double> error_pN;
    Effort effort;
    bool paused = false;
    std::string problem;  // why the last Reset failed; else empty
};

// How the servo fares.
struct ServoHealth {
    std::uint64_t overruns = 0;  // ticks that were skipped because one began too late
    bool real_time = false;      // the system granted real-time priority
    bool locked = false;         // and lets memory stay where it is
};

}  // namespace palpa
