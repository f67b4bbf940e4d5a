// Commands to a running scene, and its readout.
#pragma once
#include "haptics/exchange.h"
#include "scene/description.h"
#include "scene/edits.h"
#include "session/lesson_meter.h"
#include "session/view_additions.h"
#include "simulation/client_pull.h"
#include "simulation/playback.h"
#include "statics/accuracy_controller.h"
#include "view/build_frame.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace palpa {

// The settings that a person can change while a scene runs: the coupling of a hand, and the period
// of all steps. Hands without a coupling of their own share the scene's until a person gives them
// one.
struct LiveSettings {
    CouplingDescription coupling;
    double period_ms = 1;
    std::size_t hand = 0;

    friend bool operator==(const LiveSettings&, const LiveSettings&) = default;
};
inline LiveSettings settings_of(const SceneDescription& scene, std::size_t hand) {
    return {coupling_of(scene, hand), scene.period_ms, hand};
}
inline void set_coupling(const LiveSettings& settings, SceneDescription& scene) {
    std::optional<CouplingDescription>& own = scene.hands.at(settings.hand).coupling;
    if (settings.hand == 0 || own)
        coupling_of(scene, settings.hand) = settings.coupling;
    else if (!(scene.coupling == settings.coupling))
        own = settings.coupling;
}

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
// A person begins or ends to lead the hand of a mouse or of keys.
struct HandLead {
    std::size_t hand = 0;
    bool leads = false;
};
// Of a replay: where to go, how fast; what is not said stays.
struct ReplayOrder {
    std::optional<bool> paused{};
    std::optional<double> speed{};  // above 0
    std::optional<double> at_s{};   // going back plays the session anew up to there
};
// An edit is made at once, whatever time it says. A pull lasts until the next one.
using Command = std::variant<LiveSettings, ViewSettings, ViewAdditions, Pause, StepOnce, Reset,
                             HandLead, EditDescription, PlaybackOrder, ReplayOrder, ClientPull>;

inline EditDescription edit_now(EditAction action) {
    return {0, 0, std::move(action), {"not done"}};
}

// A recorded session that is played again.
struct ReplayState {
    double at_s = 0, length_s = 0;  // from the session's beginning
    double speed = 1;               // 1: as fast as it was recorded, or as fast as it computes
    bool is_paused = false;
    std::string verdict;  // how many rows of its trace are the same so far
};

// The names of the changes that undo and redo would take next; empty: there is none.
struct UndoReadout {
    std::string undo, redo;
    std::size_t dropped = 0;  // number of oldest entries that were dropped for lack of room
    std::string dropped_name;
    // A number that changes when undo or redo has restored settings or additions to the picture.
    std::uint64_t restored = 0;
    ViewAdditions additions;
};

// What a running scene says, all of one moment between two steps.
struct Readout {
    ContactModel contact;
    std::uint64_t steps = 0;
    double step_ms = 0;  // wall time of the last step
    // Where the scene says how exact forces must be: what nine of ten of the last error estimates
    // found at most, nothing before the first, and what a step uses for it.
    std::optional<double> error_pN;
    WorkBudget work_budget;
    bool paused = false;
    bool holds_something = true;      // the hand
    std::uint64_t snap_step = 0;      // of the last snap, a minimum that vanished; 0: none yet
    std::uint64_t resets = 0;         // so far, those that failed too
    std::uint64_t refused_edits = 0;  // so far, but for undo and redo
    std::string problem;              // why the last Reset or edit failed; else empty
    std::string engine;               // how a remote engine fares, a sentence; empty: there is none
    std::string edit_under_way;       // its name in the history; empty: none
    std::optional<PlaybackState> playback;  // where a trajectory is played
    std::optional<ReplayState> replay;      // where a recorded session is played again
    LessonMeasures lesson;                  // where the scene has one
    UndoReadout undo;
};

// The health of the servo thread.
struct ServoHealth {
    std::uint64_t overruns = 0;  // ticks that were skipped because one began too late
    bool real_time = false;      // the system granted real-time priority
    bool locked = false;         // memory is locked in RAM
};

}  // namespace palpa
