#include "app/take_input.h"

#include "app/actions.h"
#include "app/camera.h"
#include "app/draw_window.h"
#include "app/editing.h"
#include "app/hands.h"
#include "app/panels.h"
#include "app/selecting.h"
#include "app/window_world.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace palpa {
namespace {

constexpr float radians_per_pixel = 0.008F;
constexpr float zoom_per_notch = 0.9F;

void move_camera(World& app, const Input& input) {
    const auto dx = static_cast<float>(input.mouse_dx), dy = static_cast<float>(input.mouse_dy);
    const auto height = static_cast<float>(shell_of(app).window().size().height);
    const bool shifts = input.is_down(MouseButton::Right) || input.is_down(MouseButton::Middle) ||
                        (input.is_down(MouseButton::Left) && input.shift);
    const bool is_moved = input.is_down(MouseButton::Left) || shifts;
    if ((is_moved && (dx != 0 || dy != 0)) || input.wheel != 0) take_camera(app);
    OrbitCamera& camera = app.write<CameraState>().now;
    if (shifts) {
        pan(camera, dx, dy, height);
    } else if (input.is_down(MouseButton::Left)) {
        orbit(camera, -radians_per_pixel * dx, radians_per_pixel * dy);
    }
    if (input.wheel == 0) return;
    const glm::vec2 off = glm::vec2(input.mouse_x, input.mouse_y) - target_pixel(app);
    zoom_at(camera, std::pow(zoom_per_notch, static_cast<float>(input.wheel)), off.x, off.y,
            height);
}

// Gives the pad's state to its device; without focus its sticks are meant for other programs.
void post_pad(const World& app, const Input& input) {
    PadLink* const pads = options_of(app).pads;
    if (!pads) return;
    PadInput pad{.is_there = input.pad.has_value()};
    if (input.pad && input.focused) {
        const PadState& state = *input.pad;
        pad = {true,          state.left_x,  state.left_y,
               state.right_x, state.right_y, state.right_shoulder};
    }
    pads->inputs.post(pad);
    pads->is_there = pad.is_there;
}

// Moves the camera by the device's view control. Input that comes without focus is meant for other
// programs.
void read_device_view(World& app, const Input& input) {
    const std::vector<WindowHand>& hands = app.resource<WindowHands>().all;
    for (const WindowHand& hand : hands) hand.device->attend(input.focused);
    constexpr double longest_s = 0.1;  // after a pause nothing leaps
    const double passed_s =
        seconds_since(std::exchange(app.write<Pointer>().device_polled, SteadyClock::now()));
    const auto rate = hands.front().device->view_rate();
    if (!rate.m_per_s.isZero() || !rate.rad_per_s.isZero()) take_camera(app);
    carry(app.write<CameraState>().now, rate, std::min(passed_s, longest_s));
}

// Shows the atom under a mouse that rests; asking the graphics device for it now and then costs
// little.
void watch_hover(World& app, const Input& input, bool is_free) {
    constexpr double rest_s = 0.25;
    Pointer& pointer = app.write<Pointer>();
    const VkExtent2D size = shell_of(app).window().size();
    const bool is_inside = input.mouse_x >= 0 && input.mouse_y >= 0 && input.mouse_x < size.width &&
                           input.mouse_y < size.height;
    const bool moves = input.mouse_dx != 0 || input.mouse_dy != 0;
    if (!is_free || !is_inside || is_study(app) || moves) {
        pointer.hover.clear();
        pointer.rests_since = SteadyClock::now();
    } else if (seconds_since(pointer.rests_since) > rest_s) {
        pointer.rests_since = SteadyClock::now();
        const std::optional<std::uint32_t> atom = find_atom(app, input.mouse_x, input.mouse_y);
        pointer.hover = atom ? describe_atom(app, *atom) : std::string();
    }
}

void press_study_key(World& app) {
    StudyCourse& study = *options_of(app).study;
    if (study.stage() == StudyCourse::Stage::Done) app.write<FrameLoop>().is_quitting = true;
    const std::size_t before = study.results().size();
    if (study.press_key()) {
        LiveSettings settings = app.resource<SettingsState>().now;
        settings.coupling.mode = study.mode();
        send(app, settings);
        rest_hands(app);
        send(app, Reset{study.start_angstrom()});
    }
    if (study.results().size() > before && options_of(app).on_trial) options_of(app).on_trial();
}

void press_key(World& app, const KeyPress& press) {
    Dialogs& dialogs = app.write<Dialogs>();
    const Action* const action = find_action(press);
    const bool is_over_dialogs = action && action->over_dialogs;
    if (dialogs.question) {
        const Answer* const answer =
            press.control ? nullptr : find_answer(*dialogs.question, press.key);
        if (answer) {
            const std::function<void()> then = answer->then;
            dialogs.question.reset();
            if (then) then();
        } else if (is_over_dialogs) {
            perform(app, *action, By::Key);
        }
        return;
    }
    if (dialogs.add.is_open()) {  // letters are the dialog's own
        if (press.key == Key::Escape) return dialogs.add.close();
        return is_over_dialogs ? perform(app, *action, By::Key) : dialogs.add.press(press);
    }
    if (!is_over_dialogs && press_in_panels(app, press)) return;
    if (is_study(app) && press.key == Key::Enter) return press_study_key(app);
    if (action) perform(app, *action, By::Key);
}

}  // namespace

void take_input(World& app) {
    WindowShell& shell = shell_of(app);
    const Input& input = shell.window().poll();
    PictureState& picture = app.write<PictureState>();
    picture.must_rebuild = picture.must_rebuild || input.resized;
    if (input.rescaled) shell.restart_graphics();
    read_device_view(app, input);
    post_pad(app, input);
    for (const KeyPress& press : input.pressed) press_key(app, press);
    take_dropped(app, input.dropped);
    lead_hands(app, input, types_text());
    // A drag belongs to what lies where it began, however fast the mouse goes.
    const UiBackend& ui = shell.graphics()->ui;
    Pointer& pointer = app.write<Pointer>();
    for (const MousePress& press : input.clicked) pointer.drags_panel = ui.covers(press.x, press.y);
    const bool is_dragging = std::ranges::find(input.down, true) != input.down.end();
    const bool is_on_panel = is_dragging || !input.clicked.empty()
                                 ? pointer.drags_panel
                                 : ui.covers(input.mouse_x, input.mouse_y);
    const bool draws_box = drag_box(app, input);
    const bool holds = app.resource<WindowHands>().holds;
    const bool is_asked = app.resource<Dialogs>().is_open();
    if (!holds && !is_on_panel && !is_asked && !draws_box) {
        move_camera(app, input);
        if (input.double_clicked) look_at_pixel(app, input.mouse_x, input.mouse_y);
    }
    if (input.double_clicked) app.write<PendingEdits>().click.reset();
    if (!holds && !is_asked)
        for (const MouseClick& ended : input.clicks) click_atom(app, ended);
    take_clicked(app);
    watch_hover(app, input, !holds && !is_asked && !is_on_panel && !is_dragging);
}

}  // namespace palpa
