#include "devices/emulated_omni.h"

#include "core/units.h"
#include "haptics/local_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

constexpr int sub_steps = 4;
constexpr double sub_step_s = servo_tick_s / sub_steps;

// What the ends of the workspace feel like.
constexpr double stop_stiffness_N_per_m = 2e4;
constexpr double stop_damping_N_s_per_m = 20;

// How quickly a live hand goes where the mouse is: as a critically damped mass would.
constexpr double live_hand_rad_per_s = 40;

// Force of the stop on a handle that is `position` from the centre; never pulls. A light handle
// gets a softer stop: a sub-step of it must not throw the handle further than it came.
double stop_force(double position, double velocity, double half_width, double mass) noexcept {
    const double depth = std::abs(position) - half_width;
    if (depth <= 0) return 0;
    const double stiffness =
        std::min(stop_stiffness_N_per_m, 0.1 * mass / (sub_step_s * sub_step_s));
    const double damping = std::min(stop_damping_N_s_per_m, 0.3 * mass / sub_step_s);
    const double outward = std::copysign(1.0, position);
    return -outward * std::max(stiffness * depth + damping * velocity * outward, 0.0);
}

// How far (m) a hand that goes by sight is ahead of a handle that does not come.
double most_ahead(const std::optional<HandModel>& hand) noexcept {
    return hand && hand->stiffness_N_per_m > 0 ? live_hand_newton / hand->stiffness_N_per_m : 0;
}

}  // namespace

EmulatedOmni::EmulatedOmni(const EmulatedOmniSettings& settings)
    : settings_(settings),
      operator_(settings.script, settings.half_workspace_m, most_ahead(settings.hand)),
      time_(settings.orders) {
    spec_.name = "emulated Omni";
    spec_.is_real = false;
    spec_.peak_force_newton = settings.peak_force_newton;
    spec_.viscosity_N_s_per_m = settings.dynamics.viscosity_N_s_per_m;
    spec_.half_workspace_m = settings.half_workspace_m;

    const Plant plant = build_plant(settings.dynamics, settings.hand);
    plant_ = holding_plant_ = sample_plant(plant, sub_step_s);
    relaxed_plant_ =
        sample_plant(build_plant(settings.dynamics, relaxed(settings.hand)), sub_step_s);
    handle_mass_kg_ = plant.handle_mass_kg;
    // Handle and hand begin at rest where the script begins.
    orientation_ = operator_.start_orientation();
    for (std::size_t axis = 0; axis < state_.size(); ++axis) {
        PlantState& state = state_[axis];
        state = PlantState::Zero(plant.A.rows());
        state(0) = operator_.start_m()(static_cast<Eigen::Index>(axis));
        if (state.size() > 2) state(2) = state(0);
    }
}

Vec3 EmulatedOmni::true_position_m() const noexcept {
    return {state_[0](0), state_[1](0), state_[2](0)};
}

void EmulatedOmni::go_on(const std::vector<HandWaypoint>& path, bool takes_anew) {
    operator_.go_on(path, takes_anew);
}

DeviceReading EmulatedOmni::read() noexcept {
    Vec3 position = true_position_m();
    if (const double step = settings_.encoder_step_m; step > 0) {
        position = step * (position / step).array().round();
    }
    return {static_cast<double>(tick_) / spec_.rate_hz, position, buttons_, true, orientation_};
}

void EmulatedOmni::write(const Vec3& force_newton) noexcept {
    const Vec3 motors = shortened(force_newton, settings_.peak_force_newton);

    if (!take_orders()) return;
    const double now_s = static_cast<double>(tick_ - start_tick_) * servo_tick_s;
    // Half a nanosecond keeps the tick from hanging on rounding.
    if (!led_to_m_ && !released_ && now_s > settings_.script.release_s.value_or(INFINITY) - 5e-10)
        let_go();
    Vec3 drive = Vec3::Zero();
    if (led_to_m_) {
        drive = follow_mouse(*led_to_m_);
    } else if (settings_.driver == HandDriver::Mouse) {
        drive = follow_mouse(time_.target_m());
        buttons_ = time_.buttons();
    } else if (settings_.driver == HandDriver::Operator) {
        drive = follow_operator();
    } else if (!released_) {
        const ScriptedHand::Wish wish = operator_.step(servo_tick_s);
        buttons_ = wish.buttons;
        orientation_ = wish.orientation;
        if (settings_.hand) {
            drive = settings_.hand->stiffness_N_per_m * wish.place_m +
                    settings_.hand->damping_N_s_per_m * wish.m_per_s;
        }
    }
    const double kick = operator_.kick_newton(now_s);
    const Vec3 outside = motors + Vec3(kick, 0, 0);

    for (int sub_step = 0; sub_step < sub_steps; ++sub_step) {
        const Vec3 before = true_position_m();
        for (std::size_t axis = 0; axis < state_.size(); ++axis) {
            const auto i = static_cast<Eigen::Index>(axis);
            const double stop = stop_force(state_[axis](0), state_[axis](1),
                                           settings_.half_workspace_m(i), handle_mass_kg_);
            const Eigen::Vector2d inputs(outside(i) + stop, drive(i));
            state_[axis] = (plant_.A * state_[axis] + plant_.B * inputs).eval();
        }
        apply_friction(before);
    }
    ++tick_;
}

void EmulatedOmni::show(const ContactModel& contact, const Vec3& /*waiting_m*/) noexcept {
    operator_.see({units::metre_per_angstrom * contact.molecule.place_angstrom,
                   contact.displacement_gain, true_position_m(), contact.grip_number});
}

bool EmulatedOmni::take_orders() noexcept {
    const bool goes_on = time_.step();
    if (time_.was_restarted()) {
        operator_.restart();
        released_ = false;
        plant_ = holding_plant_;
        start_tick_ = tick_;
        wish_m_ = true_position_m();
        wish_m_per_s_.setZero();
    }
    return goes_on;
}

void EmulatedOmni::lead_to(const Vec3& target_m) noexcept {
    if (!led_to_m_) {
        // The hand holds on from where it is.
        if (settings_.driver == HandDriver::Script)
            wish_m_ = released_ ? true_position_m() : operator_.start_m();
        wish_m_per_s_.setZero();
        released_ = false;
        plant_ = holding_plant_;
        buttons_ = 0;
    }
    led_to_m_ = target_m;
}

Vec3 EmulatedOmni::follow_mouse(const Vec3& target_m) noexcept {
    if (!settings_.hand) return Vec3::Zero();
    const double stiffness = settings_.hand->stiffness_N_per_m;
    const Vec3& reach = settings_.half_workspace_m;
    const Vec3 handle = true_position_m();
    const double w = live_hand_rad_per_s;
    const Vec3 before = wish_m_;
    wish_m_per_s_ += servo_tick_s * (w * w * (target_m - wish_m_) - 2 * w * wish_m_per_s_);
    wish_m_per_s_ *= std::min(1.0, live_hand_m_per_s / std::max(wish_m_per_s_.norm(), 1e-12));
    wish_m_ += servo_tick_s * wish_m_per_s_;
    const Vec3 ahead = wish_m_ - handle;
    const double pull = stiffness * ahead.norm();
    if (pull > live_hand_newton) wish_m_ = handle + ahead * (live_hand_newton / pull);
    wish_m_ = wish_m_.cwiseMax(-reach).cwiseMin(reach);
    // Held back, the damper pulls no more either.
    wish_m_per_s_ = (wish_m_ - before) / servo_tick_s;
    return drive_of(*settings_.hand);
}

Vec3 EmulatedOmni::follow_operator() noexcept {
    if (!settings_.hand) return Vec3::Zero();
    wish_m_per_s_ = (time_.target_m() - wish_m_) / servo_tick_s;
    wish_m_ = time_.target_m();
    return drive_of(*settings_.hand);
}

Vec3 EmulatedOmni::drive_of(const HandModel& hand) const noexcept {
    return hand.stiffness_N_per_m * wish_m_ + hand.damping_N_s_per_m * wish_m_per_s_;
}

void EmulatedOmni::let_go() noexcept {
    released_ = true;
    plant_ = relaxed_plant_;
    buttons_ = 0;
}

// Takes speed away from the handle, whatever its direction, down to rest. A handle at rest stays
// where it is until a sub-step's push would give it more speed than that.
void EmulatedOmni::apply_friction(const Vec3& before) noexcept {
    const double loss = settings_.friction_newton / handle_mass_kg_ * sub_step_s;
    if (loss <= 0) return;
    const Vec3 velocity(state_[0](1), state_[1](1), state_[2](1));
    const double speed = velocity.norm();
    const bool stops = speed <= loss;
    const double kept = stops ? 0 : 1 - loss / speed;
    for (std::size_t axis = 0; axis < state_.size(); ++axis) {
        state_[axis](1) *= kept;
        if (stops && resting_) state_[axis](0) = before(static_cast<Eigen::Index>(axis));
    }
    resting_ = stops;
}

}  // namespace palpa
