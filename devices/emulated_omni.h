// An emulated Phantom Omni with the hand on it: inertia, viscosity, Coulomb friction, encoder
// steps, saturating motors, stops at the ends of the workspace, buttons. The hand follows a script,
// a person's mouse or an emulated operator. Turning the handle meets no resistance.
#pragma once
#include "core/omni.h"
#include "devices/ordered_time.h"
#include "devices/scripted_hand.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "haptics/plant.h"
#include "math/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// Half of the nominal workspace of 160 x 120 x 70 mm.
inline const Vec3 omni_half_workspace_m{0.080, 0.060, 0.035};

// What sets the target of the hand. With a mouse the hand follows the target of the orders at a
// human speed; with an operator it has the target at once.
enum class HandDriver { Script, Mouse, Operator };

// Defaults from the maker's data sheet of the Omni. Inertia, friction and encoder step are not
// verified on a device.
struct EmulatedOmniSettings {
    DeviceDynamics dynamics;                      // 45 g; the viscosity is assumed
    double friction_newton = 0.26;                // Coulomb friction when the handle is moved
    double encoder_step_m = 0.055e-3;             // 0: exact positions
    double peak_force_newton = omni_peak_newton;  // saturation of the motors
    std::optional<HandModel> hand;                // unset: nobody holds the handle
    HandScript script;
    HandOrders* orders = nullptr;  // targets from a window or an operator
    HandDriver driver = HandDriver::Script;
    Vec3 half_workspace_m = omni_half_workspace_m;
    int servo_delay_ticks = 1;  // of the servo's forces, for a mouse in the place of this device
};

// Runs on the servo's clock: each write() advances device and hand by one tick, exactly for the
// linear part, and in four sub-steps for friction and stops. The same settings always give the same
// motion.
class EmulatedOmni final : public Device {
public:
    explicit EmulatedOmni(const EmulatedOmniSettings& settings);

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override;
    void show(const ContactModel& contact, const Vec3& waiting_m) noexcept override;

    // From now on the hand follows this target (m, from the centre) as a mouse hand does, in place
    // of its script. Without a hand nothing happens. Call it on the thread that calls write().
    void lead_to(const Vec3& target_m) noexcept;
    bool has_hand() const noexcept { return settings_.hand.has_value(); }
    // Appends to the script (scripted_hand.h). Not while a servo runs on another thread.
    void go_on(const std::vector<HandWaypoint>& path, bool takes_anew = false);

    // The exact position of the handle, without the resolution of the encoder, m.
    Vec3 true_position_m() const noexcept;

private:
    // Whether time advances: false while the orders stop it.
    bool take_orders() noexcept;
    // Target force of the hand's spring and damper towards the mouse, N, for each axis.
    Vec3 follow_mouse(const Vec3& target_m) noexcept;
    Vec3 follow_operator() noexcept;
    // Force of the hand's spring and damper for the present target and its speed, N.
    Vec3 drive_of(const HandModel& hand) const noexcept;

    // From now on the hand has no target: only its mass and damping act.
    void let_go() noexcept;
    // `before`: position of the handle one sub-step earlier, m.
    void apply_friction(const Vec3& before) noexcept;

    EmulatedOmniSettings settings_;
    DeviceSpec spec_;
    ScriptedHand operator_;
    // Dynamics over one sub-step: the present one; while the hand holds; after it has let go.
    SampledPlant plant_, holding_plant_, relaxed_plant_;
    bool released_ = false;
    double handle_mass_kg_ = 0;
    std::array<PlantState, 3> state_;  // one per axis
    bool resting_ = true;              // friction held the handle during the last sub-step
    OrderedTime time_;
    std::optional<Vec3> led_to_m_;  // target of lead_to(), in place of the driver's
    Vec3 wish_m_ = Vec3::Zero(), wish_m_per_s_ = Vec3::Zero();
    std::uint64_t tick_ = 0,
                  start_tick_ = 0;  // tick since the start; tick at which the script began
    std::uint32_t buttons_ = 0;     // as pressed during the last tick
    Quat orientation_ =
        Quat::Identity();  // orientation of the handle, which only the wrist changes
};

}  // namespace palpa
