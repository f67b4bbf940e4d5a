// The overlays of a running scene: what is felt and why, and everything that can be changed.
#pragma once
#include "scene/description.h"
#include "session/commands.h"
#include "session/lesson.h"
#include "ui/history.h"
#include "ui/layout.h"
#include "ui/lesson_panel.h"
#include "ui/plot.h"
#include "ui/shortcuts.h"
#include "ui/view_additions.h"
#include "view/atom_colours.h"

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpa {

// A device that a person may choose.
struct DeviceOffer {
    std::string name, summary;  // as --device takes it; in a few words
    bool is_there = true;       // as far as can be seen
    bool is_stand_in = false;   // for hardware: taken only when asked for, and never remembered
};

// What the window knows beside the readout.
struct OverlayStatus {
    ServoHealth servo;
    std::string device_name, gpu_name;
    double frame_ms = 0;
    double render_scale = 1;
    bool has_mouse_hand = true;        // the mouse can take the molecule
    bool holding = false;              // and has it
    std::string notice;                // of the last seconds, such as where a screenshot went
    std::vector<DeviceOffer> devices;  // to choose from; none: there is no choice
    std::string device;                // the one in use, of these names
    bool sounds = false;               // the force is played as a tone
    std::string hover;                 // what the mouse rests on, and what a click would take
    std::optional<double> recorded_s;  // of a recording that is under way
    std::vector<LegendEntry> legend;   // of the picture's colours
    bool selects = false;              // the panel of selections is in the lesson's place
};

class Overlay {
public:
    explicit Overlay(const SceneDescription& scene);

    void add_tick(const ServoTick& tick);

    // Describes all overlays to the overlay library, between begin and end of its frame. What the
    // person asks for is appended to `commands` and `actions`.
    void draw(const Readout& readout, const OverlayStatus& status, std::vector<Command>& commands,
              std::vector<Action>& actions);

    // Does what an action means for settings and overlays; false where it is the window's business.
    bool perform(Action action, std::vector<Command>& commands);

    // An edit was sent, the next to be undone; one that turns out refused is forgotten again.
    void note_edit();

    // What is added to the picture: a change is a step that can be undone.
    void set_additions(ViewAdditions additions);
    const ViewAdditions& additions() const noexcept { return additions_; }

    // The name of the device that the person has chosen since the last call.
    std::optional<std::string> take_device() { return std::exchange(device_, std::nullopt); }

    // The hand feels a spring, at this moment, that it cannot keep calm at the present period.
    bool is_shaking(const Readout& readout) const;

    // What no panel covers, of a window of that size in pixels: the picture's middle.
    ScreenArea free_area(float width, float height) const;

    // Closes an open list or the help; false where there is nothing to close.
    bool close_something();

    // Of the curves as they are drawn, between their axes, pixels.
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
    void draw_gain_readings(const ContactModel& contact) const;
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
    ScreenArea legend_area() const;
    void draw_recording(double seconds) const;
    void draw_help();

    void forget_refused(const Readout& readout);
    // Of the slider just described: an edit that ends becomes one step of undo.
    void remember_edit(const LiveSettings& before);
    // One slider over a setting.
    void slide(const char* label, double& value, double low, double high, const char* format,
               bool logarithmic, const char* tip);
    void set_mode(CouplingMode mode, std::vector<Command>& commands);
    void change_settings(const LiveSettings& settings, std::vector<Command>& commands);
    void update_limit();
    bool is_guarded() const noexcept { return settings_.coupling.mode == CouplingMode::Guarded; }

    SceneDescription scene_;
    LiveSettings settings_, before_edit_;
    struct EditStep {
        friend bool operator==(const EditStep&, const EditStep&) = default;
    };
    // What to go back to: of an edit the session knows it.
    using UndoStep = std::variant<EditStep, LiveSettings, ViewAdditions>;
    std::vector<UndoStep> undo_, redo_;
    ViewAdditions additions_;
    std::uint64_t refused_edits_ = 0;
    bool has_flexible_;           // molecules
    double stiffness_limit_ = 0;  // N/m that this hand keeps calm at the present period
    // How long each warning stays.
    double shaking_for_s_ = 0, clamped_for_s_ = 0, late_for_s_ = 0, at_wall_for_s_ = 0;

    Lesson lesson_;
    std::vector<double> measured_;  // of its steps, as the last readout has it
    LessonCurve lesson_curve_;
    std::optional<std::uint64_t> awaited_reset_;  // its number, while a lesson waits for it
    bool saw_reset_ = false;                      // in the last readout
    History history_;
    Reading last_;
    bool has_tick_ = false, clamped_ = false, stopped_ = false;
    SafetyStage stage_ = SafetyStage::None, reason_ = SafetyStage::None;
    double felt_N_per_m_ = 0, cap_ratio_ = 1, hand_energy_J_ = 0, overtravel_m_ = 0;
    double side_ = 0;  // of the counterpart, on one axis, where the molecule began
    bool went_through_ = false;
    bool wants_pause_ = false;
    bool is_replay_ = false;  // of a recorded session, whose settings are shown
    double force_gain_ = 0;
    float sliders_height_ = 0, plot_height_ = 0;  // pixels, as drawn last
    float left_covered_ = 0, right_covered_ = 0;  // pixels, by the panels
    bool selects_ = false;                        // the panel of selections is there

    std::optional<std::string> device_;              // just chosen
    bool left_folds_ = false, right_folds_ = false;  // the panels, for a small window
    bool shows_overlays_ = true, shows_lesson_ = true, shows_help_ = false;
    std::vector<double> x_, y_, z_;  // of the plots, kept for their room
};

// Centimetres that the handle goes for one Å of the molecule.
double cm_per_angstrom(double displacement_gain);

// The stiffness that the hand feels at this moment (N/m), at most, in the paper's modes.
double felt_stiffness(const CouplingLaws& laws, const ContactModel& contact);

}  // namespace palpa
