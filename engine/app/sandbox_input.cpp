// What mouse, keys and devices do with the view and the hands.
#include "app/sandbox.h"

#include "core/translate.h"
#include "core/units.h"
#include "render/renderer.h"
#include "ui/hand_sign.h"
#include "view/build_frame.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

constexpr float radians_per_pixel = 0.008F;
constexpr float zoom_per_notch = 0.9F;
// Of what the handle stays behind the mouse: the medium hand's newton is 1.2 Å, and leaves the
// atom.
constexpr double thread_angstrom_per_m = 240;
constexpr double key_angstrom_per_s = 2, slow_key = 0.2;
constexpr double longest_key_s = 0.1;  // that counts at once

}  // namespace

void Sandbox::take_input() {
    const Input& input = window_.poll();
    must_rebuild_ = must_rebuild_ || input.resized;
    if (input.rescaled) shell_.restart_graphics();
    read_device_view(input);
    if (options_.pads) post_pad(input);
    const auto types = [&] {
        return shell_.graphics()->ui.wants_keys() || selection_panel_.awaits_keys();
    };
    for (const KeyPress& press : input.pressed) {
        if (add_panel_.is_open() && !question_) {
            press_in_dialog(press);
        } else if (!types()) {
            press_key(press);
        } else {
            selection_panel_.press(press.key);
            // What no text is made of.
            if (press.key == Key::F12 || press.key == Key::F5) press_key(press);
        }
    }
    take_dropped(input);
    const bool leads = hand().is_led() && !types() && !is_asked();
    const double seconds = 1e-3 * ms_since(std::exchange(last_input_, SteadyClock::now()));
    const bool keys_lead = hands_[by_keys()].is_led() && !types() && !is_asked();
    if (keys_lead) move_hand_by_keys(input, std::min(seconds, longest_key_s));
    const bool held_before = std::exchange(holding_, leads && input.is_held(Key::Space));
    if (holding_ && !held_before) engage(led_);
    if (!holding_ && held_before) clutch(led_);
    if (holding_) keep_in_sight(std::min(seconds, longest_key_s));
    window_.capture_cursor(holding_);
    // A drag belongs to what lies where it began, however fast the mouse goes.
    for (const MousePress& press : input.clicked) {
        drags_panel_ = shell_.graphics()->ui.covers(press.x, press.y);
    }
    const bool is_dragging =
        std::find(input.down.begin(), input.down.end(), true) != input.down.end();
    const bool is_on_panel = is_dragging || !input.clicked.empty()
                                 ? drags_panel_
                                 : shell_.graphics()->ui.covers(input.mouse_x, input.mouse_y);
    const bool draws_box = draw_box(input);
    if (holding_) {
        // What the mouse did since the last look was done without the key, where that is new.
        if (held_before) move_hand(input);
    } else if (!is_on_panel && !is_asked() && !draws_box) {
        move_camera(input);
        if (input.double_clicked) look_at_pixel(input.mouse_x, input.mouse_y);
    }
    if (input.double_clicked) wanted_.reset();
    if (!holding_ && !is_asked()) {
        for (const MouseClick& ended : input.clicks) click(ended);
    }
    take_clicked();
    watch_hover(input, !holding_ && !is_asked() && !is_on_panel && !is_dragging);
}

void Sandbox::move_camera(const Input& input) {
    const auto dx = static_cast<float>(input.mouse_dx), dy = static_cast<float>(input.mouse_dy);
    const bool shifts = input.is_down(MouseButton::Right) || input.is_down(MouseButton::Middle) ||
                        (input.is_down(MouseButton::Left) && input.shift);
    const bool is_moved = input.is_down(MouseButton::Left) || shifts;
    if ((is_moved && (dx != 0 || dy != 0)) || input.wheel != 0) {
        take_camera();
    }
    if (shifts) {
        pan(camera_, dx, dy, static_cast<float>(window_.size().height));
    } else if (input.is_down(MouseButton::Left)) {
        orbit(camera_, -radians_per_pixel * dx, radians_per_pixel * dy);
    }
    if (input.wheel == 0) return;
    const glm::vec2 off = glm::vec2(input.mouse_x, input.mouse_y) - target_pixel();
    zoom_at(camera_, std::pow(zoom_per_notch, static_cast<float>(input.wheel)), off.x, off.y,
            static_cast<float>(window_.size().height));
}

// Without focus its sticks are meant for others.
void Sandbox::post_pad(const Input& input) {
    PadInput pad{.is_there = input.pad.has_value()};
    if (input.pad && input.focused) {
        const PadState& state = *input.pad;
        pad = {true,          state.left_x,  state.left_y,
               state.right_x, state.right_y, state.right_shoulder};
    }
    options_.pads->inputs.post(pad);
    options_.pads->is_there = pad.is_there;
}

// Input that comes without focus is meant for others.
void Sandbox::read_device_view(const Input& input) {
    for (const WindowHand& each : hands_) each.device->attend(input.focused);
    constexpr double longest_s = 0.1;  // after a pause nothing leaps
    const double passed_s =
        std::chrono::duration<double>(SteadyClock::now() - device_polled_).count();
    device_polled_ = SteadyClock::now();
    const auto rate = hands_.front().device->view_rate();
    if (!rate.m_per_s.isZero() || !rate.rad_per_s.isZero()) take_camera();
    carry(camera_, rate, std::min(passed_s, longest_s));
}

void Sandbox::move_hand(const Input& input) {
    pull(led_, find_mouse_way(camera_, as_float(in_hand().grabbed_angstrom),
                              static_cast<float>(window_.size().height),
                              static_cast<float>(input.mouse_dx),
                              static_cast<float>(input.mouse_dy), static_cast<float>(input.wheel)));
}

void Sandbox::move_hand_by_keys(const Input& input, double seconds) {
    const auto along = [&](Key forth, Key back) {
        return static_cast<float>(input.is_held(forth)) - static_cast<float>(input.is_held(back));
    };
    const glm::vec3 way = along(Key::Right, Key::Left) * rightward(camera_) +
                          along(Key::Up, Key::Down) * upward(camera_) -
                          along(Key::PageUp, Key::PageDown) * backward(camera_);
    if (way == glm::vec3(0)) {
        if (!holding_ || by_keys() != led_) lead(by_keys(), false);
        return;
    }
    engage(by_keys());
    pull(by_keys(),
         static_cast<float>(key_angstrom_per_s * (input.shift ? slow_key : 1) * seconds) * way);
}

// The molecule would go this way (Å) where nothing holds it: handle travel is A_d times its way.
void Sandbox::pull(std::size_t slot, const glm::vec3& way) {
    hands_[slot].lead.pull({way.x, way.y, way.z});
    follow_lead(slot);
}

void Sandbox::follow_lead(std::size_t slot) {
    const MouseLead& lead = hands_[slot].lead;
    if (hands_[slot].is_led()) session_.move_hand(lead.target_m(), slot, lead.is_clutched());
}

// A hand that mouse or keys lead stays where its handle is: it pulls at nothing.
void Sandbox::rest(std::size_t slot) {
    hands_[slot].lead.rest();
    follow_lead(slot);
}

// The hand takes hold of the molecule where the handle is.
void Sandbox::engage(std::size_t slot) {
    hands_[slot].lead.engage();
    follow_lead(slot);
    lead(slot, true);
}

// The molecule stays where it is, and the handle goes back to its middle.
void Sandbox::clutch(std::size_t slot) {
    hands_[slot].lead.clutch();
    follow_lead(slot);
    lead(slot, false);
}

// Tells the session that a person begins or ends to lead the hand, for undo.
void Sandbox::lead(std::size_t slot, bool leads) {
    if (std::exchange(hands_[slot].is_leading, leads) != leads)
        session_.send(HandLead{slot, leads});
}

void Sandbox::rest_all() {
    for (std::size_t slot = 0; slot < hands_.size(); ++slot) rest(slot);
}

void Sandbox::exchange_hands() {
    if (hands_.size() < 2)
        return notice(translated(
            "this scene has one hand; another table [[hand]] in the scene file adds a second"));
    if (holding_) clutch(led_);
    led_ = by_keys();
    if (holding_) engage(led_);
    held_address_ = in_hand().held_address;
    notice(format_translated("the mouse moves the {} hand ({}); the arrow keys move the other",
                             led_ == 0 ? translated("first") : translated("second"),
                             held_address_.empty() ? translated("empty") : held_address_));
}

// Moves the camera so that panels never cover what the hand leads: all of it where it fits, else
// its atom in hand.
void Sandbox::keep_in_sight(double seconds) {
    constexpr float margin = 0.05F, margin_of_atom = 0.15F;  // of the area without panels
    constexpr double catches_up_s = 0.15;
    const LiveHand& led = frame_.hands[led_];
    const VkExtent2D size = shell_.graphics()->swapchain.size();
    if (!has_frame_ || led.held.count == 0 || size.width == 0 || size.height == 0) return;
    const ScreenArea area = free_area();
    if (area.width() <= 0 || area.height() <= 0) return;
    const auto see = [&](const glm::vec3& place) {
        return project(shown_.camera, place, size.width, size.height);
    };
    const glm::vec3 grabbed = see(as_float(led.grabbed_angstrom));
    if (!(grabbed.z > shown_.camera.near)) return;
    glm::vec3 first = grabbed, last = grabbed;
    const std::size_t end =
        std::min<std::size_t>(led.held.first + led.held.count, frame_.places.size());
    for (std::size_t i = led.held.first; i < end; ++i) {
        const glm::vec3 seen = see(frame_.places[i]);
        first = glm::min(first, seen);
        last = glm::max(last, seen);
    }
    const float room = 1 - 2 * margin;
    const bool fits = first.z > shown_.camera.near && last.x - first.x < room * area.width() &&
                      last.y - first.y < room * area.height();
    if (!fits) first = last = grabbed;
    const auto beyond = [&](float least, float most, float low, float high) {
        const float edge = (fits ? margin : margin_of_atom) * (high - low);
        return std::min(least - low - edge, 0.0F) + std::max(most - high + edge, 0.0F);
    };
    const auto share = static_cast<float>(1 - std::exp(-seconds / catches_up_s));
    const float right = beyond(first.x, last.x, area.left, area.right);
    const float down = beyond(first.y, last.y, area.top, area.bottom);
    if (right == 0 && down == 0) return;
    take_camera();
    pan(camera_, -share * right, -share * down, static_cast<float>(size.height));
}

// Returns the place (Å) to which a hand wants its molecule: ahead of it by the lead of mouse or
// keys over the handle, and by the travel that waits.
Vec3 Sandbox::find_wish(std::size_t slot) const {
    const WindowHand& hand = hands_[slot];
    Vec3 wish = frame_.hands[slot].grabbed_angstrom;
    if (hand.is_led()) wish += thread_angstrom_per_m * hand.lead.ahead_m();
    if (const double A_d = hand.lead.displacement_gain(); A_d > 0)
        wish += units::angstrom_per_metre / A_d * hand.waiting_m;
    return wish;
}

// A study shows nothing of it.
void Sandbox::show_wish() {
    if (options_.study) return;
    for (std::size_t slot = 0; slot < hands_.size(); ++slot) {
        if (frame_.hands[slot].held.count == 0) continue;
        add_wish(as_float(frame_.hands[slot].grabbed_angstrom), as_float(find_wish(slot)),
                 backward(camera_), shown_);
    }
}

// The first time that the signs of the hand appear to a user.
void Sandbox::explain_hand(double most_newton) {
    if (std::exchange(is_hand_explained_, true)) return;
    notice(format_translated("Ring: where your hand wants the molecule. Dashed thread: how far it "
                             "stays behind. Bar: the force on your hand, full at {:.3g} N.",
                             most_newton),
           first_notice_s);
    if (options_.remember_hand_explained) options_.remember_hand_explained();
}

// The force on each hand, and why its molecule does not follow, beside the ring.
void Sandbox::draw_hand() {
    constexpr double least_waiting_m = 0.002, faintest_newton = 0.02;
    for (std::size_t slot = 0; slot < hands_.size(); ++slot) {
        const WindowHand& hand = hands_[slot];
        if (frame_.hands[slot].held.count == 0) continue;
        HandSign sign{as_float(find_wish(slot)), hand.felt_newton,
                      overlay_.settings().coupling.clamp_N};
        if (hand.is_at_stop) {
            sign.reason = translated("handle's end");
        } else if (hand.is_at_wall) {
            sign.reason = translated("at wall");
        } else if (hand.waiting_m.norm() > least_waiting_m) {
            sign.reason = translated("molecule waits");
        }
        if (sign.reason.empty() && sign.newton < faintest_newton) continue;
        explain_hand(sign.most_newton);
        draw_hand_sign(sign, shown_.camera, free_area());
    }
}

// Letters and all else are the dialog's own.
void Sandbox::press_in_dialog(const KeyPress& press) {
    if (press.key == Key::Escape) return add_panel_.close();
    const std::optional<Action> action = find_action(press.key, press.control, press.shift);
    const bool is_for_all = action == Action::Screenshot || action == Action::RestartGraphics ||
                            action == Action::LargerText || action == Action::SmallerText ||
                            action == Action::UsualText;
    if (is_for_all) return perform(*action);
    add_panel_.press(press);
}

void Sandbox::press_key(const KeyPress& press) {
    if (question_) {
        const Answer* const answer = press.control ? nullptr : find_answer(*question_, press.key);
        if (answer) return give(*answer);
        if (find_action(press.key, press.control, press.shift) != Action::Screenshot) return;
    }
    if (options_.study && press.key == Key::Enter) return press_study_key();
    if (const std::optional<Action> action = find_action(press.key, press.control, press.shift)) {
        perform(*action);
    }
}

}  // namespace palpa
