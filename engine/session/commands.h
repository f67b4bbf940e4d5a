// Commands to a running scene, and its readout.
#pragma once
#include "haptics/exchange.h"
#include "scene/description.h"
#include "scene/edits.h"
#include "session/lesson_meter.h"
#include "simulation/accuracy_controller.h"
#include "simulation/client_pull.h"
#include "simulation/playback.h"
#include "view/build_frame.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace palpa {

// The settings that a person can change while a scene runs.
struct LiveSettings {
    CouplingDescription coupling;
    double period_ms = 1;

    friend bool operator==(const LiveSettings&, const LiveSettings&) = default;
};

// Commands are taken between two steps, in the order in which they were sent.
struct Pause {
    bool paused = true;  // while paused nothing moves and the hand has no force
};
struct StepOnce {};  // one step, then pause
// Load the scene again; the settings stay.
struct Reset {
    // On a line: new start distance, Å; unset: unchanged.
    std::optional<double> start_angstrom{};
};
// An edit is made at once, whatever its time. A pull lasts until the next one.
using Command = std::variant<LiveSettings, ViewSettings, Pause, StepOnce, Reset, EditDescription,
                             PlaybackOrder, ClientPull>;

inline EditDescription edit_now(EditAction action) {
    return {0, 0, std::move(action), {"not done"}};
}

// The state of a running scene, consistent for one moment between two steps.
struct Readout {
    ContactModel contact;
    std::uint64_t steps = 0;
    double step_ms = 0;  // wall time of the last step
    // Where the scene says how exact forces must be: what nine of ten of the last error estimates
    // found at most, nothing before the first, and what a step uses for it.
    std::optional<double> error_pN;
    WorkBudget work_budget;
    bool paused = false;
    bool holds_something = true;            // whether the hand holds something
    std::uint64_t refused_edits = 0;        // number of refused edits, without undo and redo
    std::string problem;                    // why the last Reset or edit failed; else empty
    std::string engine;                     // state of a remote engine as a sentence; empty: none
    std::string edit_under_way;             // key of the running edit; empty: none
    std::optional<PlaybackState> playback;  // while a trajectory is played
    LessonMeasures lesson;                  // if the scene has a lesson
};

// The health of the servo thread.
struct ServoHealth {
    std::uint64_t overruns = 0;  // ticks that were skipped because one began too late
    bool real_time = false;      // the system granted real-time priority
    bool locked = false;         // memory is locked in RAM
};

}  // namespace palpa
