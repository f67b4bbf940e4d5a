// The overlays of a running scene: what is felt and why, and everything that can be changed.
#pragma once
#include "scene/description.h"
#include "session/commands.h"
#include "session/lesson.h"
#include "ui/history.h"
#include "ui/shortcuts.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

// A device that a person may choose.
struct DeviceOffer {
    std::string name, summary;  // as --device takes it; in a few words
    bool is_there = true;       // as far as can be seen
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

    // The name of the device that the person has chosen since the last call.
    std::optional<std::string> take_device() { return std::exchange(device_, std::nullopt); }

    // The hand feels a spring, at this moment, that it cannot keep calm at the present period.
    bool is_shaking(const Readout& readout) const;

    // Pixels at the left and at the right that the overlays cover, of a window that wide.
    float covered_pixels(float window_width) const noexcept;

    const LiveSettings& settings() const noexcept { return settings_; }
    const Lesson& lesson() const noexcept { return lesson_; }

private:
    void draw_scene(const Readout& readout, const OverlayStatus& status,
                    std::vector<Command>& commands, std::vector<Action>& actions);
    void draw_readings(const Readout& readout, const OverlayStatus& status,
                       std::vector<Action>& actions);
    void choose_device(const OverlayStatus& status);
    void draw_exactness(const Readout& readout);
    void draw_gains(std::vector<Command>& commands);
    void draw_gain_sliders();
    void choose_laws();
    void choose_range();
    void draw_history();
    void draw_lesson();
    void draw_warnings(const Readout& readout, const OverlayStatus& status);
    void draw_help();

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
    std::vector<LiveSettings> undo_, redo_;
    double stiffness_limit_ = 0;  // N/m that this hand keeps calm at the present period
    // How long each warning stays.
    double shaking_for_s_ = 0, clamped_for_s_ = 0, late_for_s_ = 0;

    Lesson lesson_;
    History history_;
    Reading last_;
    bool has_tick_ = false, clamped_ = false, stopped_ = false;
    SafetyStage stage_ = SafetyStage::None, reason_ = SafetyStage::None;
    double felt_N_per_m_ = 0, raised_ = 1, hand_energy_J_ = 0, kept_m_ = 0;
    double side_ = 0;  // of the counterpart, on one axis, where the molecule began
    bool went_through_ = false;
    bool wants_pause_ = false;
    double force_gain_ = 0;
    float gains_bottom_ = 0;  // pixels, where the next panel of that column may begin

    std::optional<std::string> device_;  // just chosen
    bool shows_overlays_ = true, shows_lesson_ = true, shows_help_ = false;
    std::vector<double> x_, y_, z_;  // of the plots, kept for their room
};

}  // namespace palpa
