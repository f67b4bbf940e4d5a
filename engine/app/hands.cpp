#include "app/hands.h"

#include "app/camera.h"
#include "app/notices.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/hands.h"
#include "core/translate.h"
#include "core/units.h"
#include "render/renderer.h"
#include "ui/hand_sign.h"
#include "view/build_frame.h"
#include "view/signs.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

// How far the thread is drawn for the handle's lag behind the mouse: a newton of the medium hand is
// 1.2 Å, which leaves the atom.
constexpr double thread_angstrom_per_m = 240;
constexpr double key_angstrom_per_s = 2, slow_key = 0.2;
constexpr double longest_key_s = 0.1;  // that counts at once

void follow_lead(World& app, std::size_t slot) {
    const WindowHand& hand = app.resource<WindowHands>().all[slot];
    if (hand.is_led())
        session_of(app).move_hand(hand.lead.target_m(), slot, hand.lead.is_clutched());
}

// Tells the session that a person begins or ends to lead the hand, for undo.
void note_lead(World& app, std::size_t slot, bool leads) {
    if (std::exchange(app.write<WindowHands>().all[slot].is_leading, leads) != leads)
        send(app, HandLead{slot, leads});
}

// Moves the target so that the molecule would go this way (Å) if nothing held it.
void pull_hand(World& app, std::size_t slot, const glm::vec3& way) {
    app.write<WindowHands>().all[slot].lead.pull({way.x, way.y, way.z});
    follow_lead(app, slot);
}

void lead_by_mouse(World& app, const Input& input) {
    const glm::vec3 way =
        find_mouse_way(app.resource<CameraState>().now, as_float(led_hand(app).grabbed_angstrom),
                       static_cast<float>(shell_of(app).window().size().height),
                       static_cast<float>(input.mouse_dx), static_cast<float>(input.mouse_dy),
                       static_cast<float>(input.wheel));
    pull_hand(app, app.resource<WindowHands>().led, way);
}

void lead_by_keys(World& app, const Input& input, double seconds) {
    const OrbitCamera& camera = app.resource<CameraState>().now;
    const WindowHands& hands = app.resource<WindowHands>();
    const std::size_t slot = hands.by_keys();
    const auto along = [&](Key forth, Key back) {
        return static_cast<float>(input.is_held(forth)) - static_cast<float>(input.is_held(back));
    };
    const glm::vec3 way = along(Key::Right, Key::Left) * rightward(camera) +
                          along(Key::Up, Key::Down) * upward(camera) -
                          along(Key::PageUp, Key::PageDown) * backward(camera);
    if (way == glm::vec3(0)) {
        if (!hands.holds || slot != hands.led) note_lead(app, slot, false);
        return;
    }
    engage(app, slot);
    pull_hand(
        app, slot,
        static_cast<float>(key_angstrom_per_s * (input.shift ? slow_key : 1) * seconds) * way);
}

// Moves the camera so that panels never cover what the hand leads: all of it if it fits, else its
// atom in hand.
void keep_in_sight(World& app, double seconds) {
    constexpr float margin = 0.05F, margin_of_atom = 0.15F;  // of the area without panels
    constexpr double catches_up_s = 0.15;
    const LiveFrame& frame = frame_of(app);
    const LiveHand& led = led_hand(app);
    const FrameCamera& seen_by = app.resource<PictureState>().shown.camera;
    const VkExtent2D size = shell_of(app).graphics()->swapchain.size();
    if (!has_frame(app) || led.held.count == 0 || size.width == 0 || size.height == 0) return;
    const ScreenArea area = free_area(app);
    if (area.width() <= 0 || area.height() <= 0) return;
    const auto see = [&](const glm::vec3& place) {
        return project(seen_by, place, size.width, size.height);
    };
    const glm::vec3 grabbed = see(as_float(led.grabbed_angstrom));
    if (!(grabbed.z > seen_by.near)) return;
    glm::vec3 first = grabbed, last = grabbed;
    const std::size_t end =
        std::min<std::size_t>(led.held.first + led.held.count, frame.places.size());
    for (std::size_t i = led.held.first; i < end; ++i) {
        const glm::vec3 seen = see(frame.places[i]);
        first = glm::min(first, seen);
        last = glm::max(last, seen);
    }
    const float room = 1 - 2 * margin;
    const bool fits = first.z > seen_by.near && last.x - first.x < room * area.width() &&
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
    take_camera(app);
    pan(app.write<CameraState>().now, -share * right, -share * down,
        static_cast<float>(size.height));
}

// The place (Å) to which a hand wants its molecule: ahead of it by the lead of mouse or keys over
// the handle, and by the travel that waits.
Vec3 find_hand_target(const World& app, std::size_t slot) {
    const WindowHand& hand = app.resource<WindowHands>().all[slot];
    Vec3 wish = frame_of(app).hands[slot].grabbed_angstrom;
    if (hand.is_led()) wish += thread_angstrom_per_m * hand.lead.ahead_m();
    if (const double A_d = hand.lead.displacement_gain(); A_d > 0)
        wish += units::angstrom_per_metre / A_d * hand.waiting_m;
    return wish;
}

// Explains the signs of the hand to a user who sees them for the first time.
void explain_hand(World& app, double most_newton) {
    if (std::exchange(app.write<WindowHands>().is_explained, true)) return;
    tell(app,
         format_translated("Ring: where your hand wants the molecule. Dashed thread: how far it "
                           "stays behind. Bars: the force on the molecule, and the force on your "
                           "hand, full at {:.3g} N.",
                           most_newton),
         long_notice_s);
    (void)keep_choice(options_of(app).remember_hand_explained, true);
}

}  // namespace

void lead_hands(World& app, const Input& input, bool types) {
    Pointer& pointer = app.write<Pointer>();
    const double seconds = std::min(
        seconds_since(std::exchange(pointer.last_input, SteadyClock::now())), longest_key_s);
    WindowHands& hands = app.write<WindowHands>();
    const bool is_free = !types && !app.resource<Dialogs>().is_open();
    if (is_free && hands.all[hands.by_keys()].is_led()) lead_by_keys(app, input, seconds);
    const bool held_before = std::exchange(
        hands.holds, is_free && hands.by_mouse().is_led() && input.is_held(Key::Space));
    if (hands.holds && !held_before) engage(app, hands.led);
    if (!hands.holds && held_before) clutch(app, hands.led);
    if (hands.holds) keep_in_sight(app, seconds);
    shell_of(app).window().capture_cursor(hands.holds);
    // The mouse's way since the last look was made without the key, if that is new.
    if (hands.holds && held_before) lead_by_mouse(app, input);
}

void engage(World& app, std::size_t slot) {
    app.write<WindowHands>().all[slot].lead.engage();
    follow_lead(app, slot);
    note_lead(app, slot, true);
}

void clutch(World& app, std::size_t slot) {
    app.write<WindowHands>().all[slot].lead.clutch();
    follow_lead(app, slot);
    note_lead(app, slot, false);
}

void rest_hands(World& app) {
    WindowHands& hands = app.write<WindowHands>();
    for (std::size_t slot = 0; slot < hands.all.size(); ++slot) {
        hands.all[slot].lead.rest();
        follow_lead(app, slot);
    }
}

const char* name_of_hand(std::size_t hand) {
    constexpr std::array<const char*, most_hands> names{
        for_translation("first"), for_translation("second"), for_translation("third"),
        for_translation("fourth")};
    return translated(names.at(hand));
}

void exchange_hands(World& app) {
    WindowHands& hands = app.write<WindowHands>();
    if (hands.all.size() < 2)
        return tell(app, translated("this scene has one hand; another table [[hand]] in the scene "
                                    "file adds a second"));
    if (hands.holds) clutch(app, hands.led);
    hands.led = hands.by_keys();
    if (hands.holds) engage(app, hands.led);
    hands.held_address = led_hand(app).held_address;
    show_settings_of_led(app);
    tell(app,
         format_translated("the mouse moves the {} hand ({}); the arrow keys move the other",
                           name_of_hand(hands.led),
                           hands.held_address.empty() ? translated("empty") : hands.held_address));
}

void show_hand_targets(World& app) {
    if (is_study(app)) return;
    const LiveFrame& frame = frame_of(app);
    FrameScene& shown = app.write<PictureState>().shown;
    const glm::vec3 towards_eye = backward(app.resource<CameraState>().now);
    for (std::size_t slot = 0; slot < app.resource<WindowHands>().all.size(); ++slot) {
        if (frame.hands[slot].held.count == 0) continue;
        add_wish(as_float(frame.hands[slot].grabbed_angstrom),
                 as_float(find_hand_target(app, slot)), towards_eye, shown);
    }
}

void draw_hand_signs(World& app) {
    constexpr double least_waiting_m = 0.002, faintest_newton = 0.02, faintest_nN = 0.005;
    const std::vector<WindowHand>& hands = app.resource<WindowHands>().all;
    const FrameCamera& camera = app.resource<PictureState>().shown.camera;
    for (std::size_t slot = 0; slot < hands.size(); ++slot) {
        const WindowHand& hand = hands[slot];
        if (frame_of(app).hands[slot].held.count == 0) continue;
        const LiveHand& now = frame_of(app).hands[slot];
        HandSign sign{.place = as_float(find_hand_target(app, slot)),
                      .newton = hand.felt_newton,
                      .most_newton = now.settings.coupling.clamp_N,
                      .molecule_nN = hand.molecule_nN};
        if (hand.is_at_stop) {
            sign.reason = translated("handle's end");
        } else if (hand.is_at_wall) {
            sign.reason = translated("at wall");
        } else if (hand.waiting_m.norm() > least_waiting_m) {
            sign.reason = translated("molecule waits");
        } else if (hand.is_led() && hand.lead.is_clutched()) {
            sign.reason = translated("released");
        }
        const bool is_faint = sign.newton < faintest_newton && sign.molecule_nN < faintest_nN;
        if (is_faint && (sign.reason.empty() || hand.lead.is_clutched())) continue;
        explain_hand(app, sign.most_newton);
        draw_hand_sign(sign, camera, free_area(app));
    }
}

}  // namespace palpa
