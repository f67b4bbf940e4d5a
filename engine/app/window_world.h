// Resources of the window's world: what the frame systems (app/frame.h), panels (app/panels.h) and
// actions (app/actions.h) read and write. The window's thread owns that world. Each resource is the
// state of one theme.
#pragma once
#include "app/film_recorder.h"
#include "app/render_scale.h"
#include "app/run_window.h"
#include "app/window_session.h"
#include "app/window_shell.h"
#include "devices/mouse_lead.h"
#include "ecs/world.h"
#include "session/lesson.h"
#include "sound/pad_rumble.h"
#include "sound/speaker.h"
#include "ui/add_panel.h"
#include "ui/history.h"
#include "ui/layout.h"
#include "ui/lesson_plots.h"
#include "ui/question.h"
#include "view/orbit_camera.h"
#include "view/selected_atoms.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

using SteadyClock = std::chrono::steady_clock;

inline double seconds_since(SteadyClock::time_point begin) {
    return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

// The parts outside of the world, which they outlive; `shell` is null in tests without a window.
struct WindowLinks {
    WindowShell* shell = nullptr;
    WindowSession* session = nullptr;
    const WindowOptions* options = nullptr;
    const SceneDescription* scene = nullptr;
};

// ---- the run -----------------------------------------------------------------------------------

// The newest frame of the session.
struct NewestFrame {
    LiveFrame frame;
    bool is_there = false;  // false before the first one
};

// The loop of frames, and how it ends.
struct FrameLoop {
    SteadyClock::time_point start = SteadyClock::now();
    std::vector<double> frame_ms;
    double last_ms = 0;
    bool takes_last_shot = false;  // the screenshot of the command line is due
    bool is_quitting = false;
    std::optional<NextScreen> next;  // what is shown afterwards; none: the program ends
};

// ---- hands -------------------------------------------------------------------------------------

// A hand of the scene with its device.
struct WindowHand {
    Device* device;
    HandOrders* orders;
    double mouse_reach_m;
    MouseLead lead{mouse_reach_m};  // by mouse or keys
    bool is_leading = false;        // a person does so now
    double felt_newton = 0;         // sent to the device at this moment
    double molecule_nN = 0;         // on what is in hand, at this moment
    Vec3 waiting_m = Vec3::Zero();  // handle travel that the molecule has yet to follow
    bool is_at_wall = false;        // the contact force has stopped the molecule
    bool is_at_stop = false;        // the handle is at an end of its workspace
    Statistics statistics{servo_tick_s};

    bool is_led() const { return orders && mouse_reach_m > 0; }
};

struct WindowHands {
    std::vector<WindowHand> all;
    std::size_t led = 0;         // the hand of the mouse and of clicks
    bool holds = false;          // Space is held: the mouse moves the hand
    bool is_explained = false;   // the signs of the hand: ring, thread, bar
    std::string held_address{};  // as told last

    WindowHand& by_mouse() { return all[led]; }
    const WindowHand& by_mouse() const { return all[led]; }
    // The hand of the arrow keys: the mouse's if there is one hand.
    std::size_t by_keys() const { return (led + 1) % all.size(); }
};

// Devices to choose from, and the one in use.
struct DeviceChoice {
    DeviceMenu menu;
    std::shared_ptr<Device> chosen{};  // replaces the first hand's, unless it is the first one
    SteadyClock::time_point next_look = SteadyClock::now();
    std::string refusal{};    // of the device that was tried last
    bool has_looked = false;  // for the device that is wanted
};

// The force as a tone and as a rumble of a game pad, snaps as clicks.
struct ForceTone {
    bool is_on = false;
    std::shared_ptr<Speaker> speaker;   // null: none was found
    std::shared_ptr<PadRumble> rumble;  // null while it is off
    std::uint64_t clicks = 0;           // one for each snap so far
    std::uint64_t snap_step = 0;        // of the last one
};

// ---- the picture -------------------------------------------------------------------------------

struct CameraState {
    OrbitCamera now{};
    struct Flight {
        OrbitCamera from, to;
        SteadyClock::time_point begin;
    };
    std::optional<Flight> flight{};
    bool clips = false;  // leaves out what hides the molecule in hand
    bool looks_at_held = false;
};

struct PictureState {
    FrameScene first{};  // of the session's first frame
    bool has_first = false;
    ViewSettings view{};      // without layers, labels and what is hidden (ViewAdditions)
    ViewSettings sent{};      // to the session, with these
    FrameScene shown{};       // the frame's picture, and what the window adds to it
    VkExtent2D drawn_size{};  // of the last picture, pixels
    RenderScale scale{};
    bool must_rebuild = false;  // the swapchain
};

struct SavedViewState {
    std::vector<SavedView> all;
    std::optional<std::size_t> at{};                    // that was gone to last
    std::optional<SteadyClock::time_point> tour{};      // goes on then
    std::map<std::string, std::vector<bool>> framed{};  // atoms, by constant selections
    std::vector<bool> framed_now{};                     // atoms of the last selection
    std::string problem{};                              // of the last selection
    std::optional<std::size_t> lesson_step{};           // whose view was shown last
};

// Atoms that a person has selected.
struct SelectionState {
    std::string expression;   // empty: nothing is selected
    std::string count;        // "12 residues, 180 atoms"
    std::string problem;      // of the last requested expression, with its column
    std::vector<bool> atoms;  // empty: nothing is selected
    struct Box {
        PictureBox corners;
        bool adds = false;  // to what is selected
    };
    std::optional<Box> box;                            // that is drawn with the mouse
    std::shared_ptr<const AtomDirectory> known_atoms;  // when it was evaluated last
};

// ---- what a person changes ---------------------------------------------------------------------

// Coupling of the hand that the mouse leads, and period, as a person has set them.
struct SettingsState {
    LiveSettings now;
    std::uint64_t restored = 0;     // number of restorations by undo that are taken over
    double stiffness_limit = 0;     // N/m, the largest that is passive at the present period
    double device_cap_N_per_m = 0;  // guarded coupling: the cap of the device in use
    bool wants_pause = false;

    bool is_guarded() const noexcept { return now.coupling.mode == CouplingMode::Guarded; }
};

// The state in the scene's file, or in the file saved last.
struct WrittenState {
    std::vector<LiveSettings> settings;  // of each hand
    std::vector<SavedView> views;
    ViewAdditions additions;
    std::vector<EditAction> edits;
    SteadyClock::time_point next_crash_save = SteadyClock::now() + std::chrono::seconds(20);
};

// Edits that wait: for the second click of a double click, or for their outcome.
struct PendingEdits {
    struct Click {
        std::string address;
        SteadyClock::time_point when;
    };
    std::optional<Click> click;
    struct Announced {
        std::string molecule;
        bool is_added = true;             // false: it is removed
        std::uint64_t refused_edits = 0;  // before it
        std::string text{};               // to be told once it is done
        bool grabs = false;               // it goes into the hand
    };
    std::optional<Announced> announced;
    std::size_t forgotten = 0;  // changes that undo had no room for, as told
};

// ---- what is read ------------------------------------------------------------------------------

// The last servo ticks of the hand that the mouse leads.
struct Readings {
    History history;
    Reading last;
    bool has_tick = false;
    ServoTick tick;         // the last one
    double start_side = 0;  // on one axis: the side on which the molecule started
    bool went_through = false;
};

struct LessonState {
    Lesson lesson;
    std::vector<double> measured{};  // values of its steps in the last readout
    LessonCurve curve{};
    std::optional<std::uint64_t> awaited_reset{};  // its number, while a restart waits for it
    bool saw_reset = false;                        // in the last readout
    SteadyClock::time_point since{};               // the present step is there
    bool was_skipped = false;                      // a step, since the start
    bool is_noted = false;                         // that it is done
};

// Messages for the person: the newest for a while, all of them in the history.
struct Notices {
    std::string text;
    SteadyClock::time_point until{};
    std::vector<std::string> history;  // the last hundred, oldest first
    std::string problem{};             // why something was refused, as told last
    std::uint64_t refused = 0;         // edits, as told
    // Remaining time of each warning, s, and the mean time of a step over a second, ms.
    double shaking_s = 0, clamped_s = 0, late_s = 0, at_wall_s = 0, at_stop_s = 0;
    double mean_step_ms = 0;
};

// ---- dialogs and files -------------------------------------------------------------------------

struct Dialogs {
    std::optional<Question> question;
    AddPanel add;

    // True if something over the picture must be answered or closed first.
    bool is_open() const { return question || add.is_open(); }
};

struct Recorder {
    std::filesystem::path recorded_in, filmed_in;
    std::shared_ptr<FilmRecorder> film;
    bool wants_shot = false;
    bool warned_of_disk = false;  // in this recording
};

// The mouse over the picture.
struct Pointer {
    std::string hover;  // description of the atom under a mouse that rests
    SteadyClock::time_point rests_since = SteadyClock::now();
    SteadyClock::time_point last_input = SteadyClock::now();
    SteadyClock::time_point device_polled = SteadyClock::now();
    bool drags_panel = false;  // the drag that is under way, or was the last one
};

// ---- access ------------------------------------------------------------------------------------

inline WindowShell& shell_of(const World& app) { return *app.resource<WindowLinks>().shell; }
inline WindowSession& session_of(const World& app) { return *app.resource<WindowLinks>().session; }
inline const WindowOptions& options_of(const World& app) {
    return *app.resource<WindowLinks>().options;
}
inline const SceneDescription& scene_of(const World& app) {
    return *app.resource<WindowLinks>().scene;
}
inline const LiveFrame& frame_of(const World& app) { return app.resource<NewestFrame>().frame; }
inline bool has_frame(const World& app) { return app.resource<NewestFrame>().is_there; }
inline bool is_replay(const World& app) { return options_of(app).replay.has_value(); }
inline bool is_study(const World& app) { return options_of(app).study != nullptr; }
// The hand that the mouse leads, in the newest frame.
inline const LiveHand& led_hand(const World& app) {
    return frame_of(app).hands[app.resource<WindowHands>().led];
}
inline void send(const World& app, const Command& command) { session_of(app).send(command); }

}  // namespace palpa
