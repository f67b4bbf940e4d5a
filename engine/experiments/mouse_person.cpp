#include "experiments/mouse_person.h"

#include "core/units.h"
#include "haptics/device.h"
#include "view/place.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace palpa {
namespace {

constexpr double aims_wrong_rad = 5 * std::numbers::pi / 180;
constexpr double per_s = 5, slowest_pixels_per_s = 20;  // near the goal
constexpr double there_pixels = 2, notch_s = 0.1, notch_angstrom = 0.25;

}  // namespace

MousePerson::Motion MousePerson::act(const OrbitCamera& camera, float height, const glm::vec3& ring,
                                     const glm::vec3& goal, double passed_s) {
    Motion motion;
    if (!holds_) {
        paused_s_ += passed_s;
        if (paused_s_ < pause_s) return motion;
        holds_ = true;
        dragged_ = 0;
        error_rad_ = aims_wrong_rad * draws_.normal();
    }
    motion.holds = true;
    const glm::vec3 off = goal - ring;
    const float scale = angstrom_per_pixel(camera, ring, height);
    const glm::vec2 pixels(glm::dot(off, rightward(camera)) / scale,
                           -glm::dot(off, upward(camera)) / scale);
    const double length = glm::length(pixels);
    if (length > there_pixels) {
        const double wanted =
            passed_s * std::min(pixels_per_s, slowest_pixels_per_s + per_s * length);
        const auto share = static_cast<float>(std::min(1.0, wanted / length));
        const auto cosine = static_cast<float>(std::cos(error_rad_)),
                   sine = static_cast<float>(std::sin(error_rad_));
        motion.right = share * (cosine * pixels.x - sine * pixels.y);
        motion.down = share * (sine * pixels.x + cosine * pixels.y);
        dragged_ += share * length;
    }
    until_notch_s_ -= passed_s;
    const double inward = -glm::dot(off, backward(camera));
    if (std::abs(inward) > notch_angstrom && until_notch_s_ <= 0) {
        motion.notches = inward > 0 ? 1.0F : -1.0F;
        until_notch_s_ = notch_s;
    }
    if (dragged_ >= longest_drag_pixels) {
        holds_ = false;
        paused_s_ = 0;
    }
    return motion;
}

void MousePersonAtWindow::see(const ServoTick& tick, const Vec3& goal_angstrom) {
    constexpr float height = 720, distance = 40;  // pixels, Å
    lead_.see(tick.reading.position_m, tick.contact.displacement_gain);
    if (ticks_++ % ticks_per_frame != 0) return;
    const Vec3& place = tick.contact.molecule.place_angstrom;
    Vec3 ring = place;
    if (const double A_d = lead_.displacement_gain(); A_d > 0)
        ring += units::angstrom_per_metre / A_d * (lead_.ahead_m() + tick.waiting_m);
    constexpr double frame_s = ticks_per_frame * servo_tick_s;
    constexpr double corrects_per_s = 0.7, farthest_beyond = 3;  // Å
    beyond_ += frame_s * corrects_per_s * (goal_angstrom - place);
    if (beyond_.norm() > farthest_beyond) beyond_ *= farthest_beyond / beyond_.norm();
    OrbitCamera camera;
    camera.target = as_float(place);
    camera.distance = distance;
    const MousePerson::Motion motion =
        person_.act(camera, height, as_float(ring), as_float(goal_angstrom + beyond_), frame_s);
    if (motion.holds) {
        lead_.engage();
        const glm::vec3 way = find_mouse_way(camera, as_float(place), height, motion.right,
                                             motion.down, motion.notches);
        lead_.pull({way.x, way.y, way.z});
    } else if (!lead_.is_clutched()) {
        lead_.clutch();
    }
    HandOrder order;
    order.target_m = lead_.target_m();
    order.is_clutched = lead_.is_clutched();
    orders_.post(order);
}

}  // namespace palpa
