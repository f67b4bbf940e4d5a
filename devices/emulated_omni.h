// A Phantom Omni that is not there, and the hand on it: inertia, viscosity, Coulomb friction,
// encoder steps, saturating motors, stops at the ends of the workspace, buttons. The hand follows a
// script, a live person's mouse, or what an emulated operator wants. Nothing resists a turn.
#pragma once
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

// Who says where the hand wants the handle. A mouse's hand goes after the orders' target as a
// muscle would, an operator's has it there already.
enum class HandDriver { Script, Mouse, Operator };

// Defaults as in the maker's data sheet for the Omni; inertia, friction and encoder step are quoted
// from memory of it and are to be checked on a device.
struct EmulatedOmniSettings {
    DeviceDynamics dynamics;           // 45 g; its viscosity is assumed
    double friction_newton = 0.26;     // Coulomb, back-drive
    double encoder_step_m = 0.055e-3;  // 0: positions are read exactly
    double peak_force_newton = 3.3;    // motors give no more, whatever is written
    std::optional<HandModel> hand;     // nothing: the handle is free
    HandScript script;
    HandOrders* orders = nullptr;  // of a window or an operator
    HandDriver driver = HandDriver::Script;
    Vec3 half_workspace_m = omni_half_workspace_m;
};

// Time is the servo's: each write moves device and hand on by one tick, exactly for the linear
// part, in four sub-steps for friction and stops. The same settings give the same motion, always.
class EmulatedOmni final : public Device {
public:
    explicit EmulatedOmni(const EmulatedOmniSettings& settings);

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override;
    void show(const ContactModel& contact) noexcept override;

    // From now on the hand goes after that place (m, from the centre) as one on a mouse does,
    // whatever its script says. Without a hand nothing happens. By the thread that writes.
    void lead_to(const Vec3& target_m) noexcept;
    bool has_hand() const noexcept { return settings_.hand.has_value(); }
    // The script goes on like this (scripted_hand.h); not while a servo runs beside.
    void go_on(const std::vector<HandWaypoint>& path, bool takes_anew = false);

    // What no device knows: where the handle is between two encoder steps.
    Vec3 true_position_m() const noexcept;

private:
    // False where time stands still.
    bool take_orders() noexcept;
    // What the hand's spring and damper are drawn to (N), by axis.
    Vec3 follow_mouse(const Vec3& target_m) noexcept;
    Vec3 follow_operator() noexcept;
    // Of the present wish and its speed, by spring and damper.
    Vec3 drive_of(const HandModel& hand) const noexcept;

    // From here on the hand wants no place any more.
    void let_go() noexcept;
    // `before`: where the handle was a sub-step ago.
    void apply_friction(const Vec3& before) noexcept;

    EmulatedOmniSettings settings_;
    DeviceSpec spec_;
    ScriptedHand operator_;
    // Over one sub-step: the present one; until the hand lets go, and after.
    SampledPlant plant_, holding_plant_, relaxed_plant_;
    bool released_ = false;
    double handle_mass_kg_ = 0;
    std::array<PlantState, 3> state_;  // one per axis
    bool resting_ = true;              // friction held the handle through the last sub-step
    OrderedTime time_;
    std::optional<Vec3> led_to_m_;  // instead of what the driver says
    Vec3 wish_m_ = Vec3::Zero(), wish_m_per_s_ = Vec3::Zero();
    std::uint64_t tick_ = 0, start_tick_ = 0;  // since the beginning; where the script began
    std::uint32_t buttons_ = 0;                // as pressed during the last tick
    Quat orientation_ = Quat::Identity();      // of the handle: no motor turns it, the wrist does
};

}  // namespace palpa
