// The overlays of a running scene: readings, explanations and controls.
#pragma once
#include "scene/description.h"
#include "session/commands.h"
#include "session/lesson.h"
#include "session/statistics.h"
#include "session/view_additions.h"
#include "ui/history.h"
#include "ui/layout.h"
#include "ui/lesson_panel.h"
#include "ui/plot.h"
#include "ui/shortcuts.h"
#include "view/atom_colours.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

// A device that can be chosen.
struct DeviceOffer {
    std::string name, summary;  // name for --device; short description
    bool is_there = true;       // as far as it can be detected
    bool is_stand_in =
        false;  // a substitute for hardware: used only on request, and never remembered
};

// State of the window beside the readout.
struct OverlayStatus {
    ServoHealth servo;
    std::string device_name, gpu_name;
    double frame_ms = 0;
    double render_scale = 1;
    bool has_mouse_hand = true;  // the mouse can hold the molecule
    bool holding = false;        // the mouse holds it
    std::string notice;          // notice of the last seconds, such as the path of a screenshot
    std::vector<DeviceOffer> devices;  // devices to choose from; may be empty
    std::string device;                // name of the device in use
    bool sounds = false;               // the force is played as a tone
    std::string hover;  // description of what is under the mouse and what a click would take
    std::optional<double> recorded_s;  // length of the running recording
    std::vector<LegendEntry> legend;   // of the picture's colours
    bool selects = false;              // the panel of selections replaces the lesson
    HandTravel travel;                 // of the led hand
};

// The smallest overtravel (m) that is reported.
inline constexpr double least_overtravel_m = 0.5e-3;

class Overlay {
public:
    explicit Overlay(const SceneDescription& scene);

    void add_tick(const ServoTick& tick);

    // Describes all overlays to the overlay library; call between begin and end of its frame.
    // Appends the person's requests to `commands` and `actions`.
    void draw(const Readout& readout, const OverlayStatus& status, std::vector<Command>& commands,
              std::vector<Action>& actions);

    // Carries out an action on settings and overlays; returns false if it belongs to the window.
    bool perform(Action action, std::vector<Command>& commands);

    // Sets additions to the picture; returns false if nothing changes.
    bool set_additions(ViewAdditions additions);
    const ViewAdditions& additions() const noexcept { return additions_; }

    // The name of the device chosen since the last call.
    std::optional<std::string> take_device() { return std::exchange(device_, std::nullopt); }

    // True if the hand now feels a spring too stiff for passivity at the present period.
    bool is_shaking(const Readout& readout) const;

    // The area that no panel covers, for a window of this size in pixels.
    ScreenArea free_area(float width, float height) const;

    // Closes an open list or the help; false if nothing is open.
    bool close_something();

    // Height of the plots between their axes, pixels.
    float plot_height() const noexcept { return plot_height_; }

    const LiveSettings& settings() const noexcept { return settings_; }
    const History& history() const noexcept { return history_; }
    const Lesson& lesson() const noexcept { return lesson_; }
    bool shows_lesson() const noexcept { return shows_lesson_; }

private:
    void draw_scene(const Readout& readout, const OverlayStatus& status,
                    std::vector<Command>& commands, std::vector<Action>& actions);
    void draw_buttons(const Readout& readout, bool is_recording, std::vector<Action>& actions);
    void choose_mode(std::vector<Command>& commands);
    void draw_readings(const Readout& readout, const OverlayStatus& status,
                       std::vector<Action>& actions);
    void draw_forces(const ContactModel& contact) const;
    void draw_gain_readings(const ContactModel& contact, const HandTravel& travel) const;
    void draw_machine(const Readout& readout, const OverlayStatus& status);
    void choose_device(const OverlayStatus& status);
    void draw_comparison(const Readout& readout);
    void draw_right_panel(std::vector<Command>& commands);
    void draw_gains(std::vector<Command>& commands);
    void draw_gain_sliders();
    void choose_touch();
    void choose_laws();
    void choose_range();
    void draw_over_time();
    void draw_over_separation();
    void draw_traces(std::string_view x_label, PlotRange across);
    void fill_from_history(std::vector<double>& values, double (*value)(const Reading&));
    void draw_lesson(const Readout& readout, std::vector<Command>& commands,
                     std::vector<Action>& actions);
    void restart_lesson(const Readout& readout, std::vector<Command>& commands,
                        std::vector<Action>& actions);
    void follow_restart(const Readout& readout);
    void draw_lesson_step(const Readout& readout, std::size_t count);
    void draw_warnings(const Readout& readout, const OverlayStatus& status);
    ScreenArea area_above_panels() const;
    void draw_recording(double seconds) const;
    void draw_help();

    // Takes over what undo or redo has restored.
    void follow_undo(const UndoReadout& undo, std::vector<Command>& commands);
    // One slider for a setting.
    void slide(const char* label, double& value, double low, double high, const char* format,
               bool logarithmic, const char* tip);
    void set_mode(CouplingMode mode, std::vector<Command>& commands);
    void change_settings(const LiveSettings& settings, std::vector<Command>& commands);
    void update_limit();
    bool is_guarded() const noexcept { return settings_.coupling.mode == CouplingMode::Guarded; }

    SceneDescription scene_;
    LiveSettings settings_;
    ViewAdditions additions_;
    std::uint64_t restored_ = 0;  // number of restorations that are taken over
    bool has_flexible_;           // molecules
    double stiffness_limit_ = 0;  // N/m, largest stiffness that is passive at the present period
    // Remaining time of each warning.
    double shaking_for_s_ = 0, clamped_for_s_ = 0, late_for_s_ = 0, at_wall_for_s_ = 0,
           at_stop_for_s_ = 0;
    double mean_step_ms_ = 0;  // over about the last second

    Lesson lesson_;
    std::vector<double> measured_;  // values of the lesson's steps in the last readout
    LessonCurve lesson_curve_;
    std::optional<std::uint64_t> awaited_reset_;  // its number, while a lesson waits for it
    bool saw_reset_ = false;                      // in the last readout
    History history_;
    Reading last_;
    bool has_tick_ = false, clamped_ = false, stopped_ = false;
    SafetyStage stage_ = SafetyStage::None, reason_ = SafetyStage::None;
    double felt_N_per_m_ = 0, cap_ratio_ = 1, hand_energy_J_ = 0, overtravel_m_ = 0;
    bool is_at_stop_ = false;        // the handle is at an end of its workspace
    double device_cap_N_per_m_ = 0;  // guarded coupling: the cap of the device in use
    double side_ = 0;  // side of the counterpart on which the molecule started, in one dimension
    bool went_through_ = false;
    bool wants_pause_ = false;
    bool is_replay_ = false;  // of a recorded session, whose settings are shown
    double force_gain_ = 0;
    float sliders_height_ = 0, plot_height_ = 0;  // pixels, at the last drawing
    float left_covered_ = 0, right_covered_ = 0;  // pixels, by the panels
    bool selects_ = false;                        // the panel of selections is shown

    std::optional<std::string> device_;  // newly chosen
    bool left_folds_ = false,
         right_folds_ = false;  // whether the panels are collapsed in a small window
    bool shows_overlays_ = true, shows_lesson_ = true, shows_help_ = false;
    std::vector<double> x_, y_, z_;  // memory of the plots, reused
};

// Centimetres of handle travel per Å of the molecule.
double cm_per_angstrom(double displacement_gain);

// The largest stiffness that the hand feels now (N/m), in the paper's modes.
double felt_stiffness(const CouplingLaws& laws, const ContactModel& contact);

}  // namespace palpa
