// The safety chain, the last stage before the device: fault checks, fades, clamp, slew limit. SI
// units.
#pragma once
#include "core/omni.h"
#include "haptics/device.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace palpa {

// A mean tick of more than twice the servo's over half a second is late, though no tick is.
inline constexpr std::uint32_t slow_window_us = 500'000;
inline constexpr std::size_t slow_window_ticks = 250;

// Times count from the event to the tick that sends zero.
struct SafetySettings {
    // Limit of the norm of the force; a lower one is reached at the slew rate.
    double clamp_newton = truncation_newton;
    // False: only the clamp and the check for non-finite values act, as in the paper's loop; no
    // other setting, disengage() or end of the program has an effect.
    bool is_full = true;
    // True: the force acts from the first tick. With a real hand it starts after quiet cycles with
    // a ramp.
    bool starts_engaged = true;

    double slew_newton_per_s =
        500;  // slew limit of the sent force; a tick longer than 1 ms counts as 1 ms
    double fastest_m_per_s =
        1.5;  // largest speed of the handle; above it the force is zero at once
    double farthest_jump_m =
        0.005;                // largest jump between valid readings, per millisecond between them
    double late_s = 0.02;     // largest time since the last tick
    double gone_s = 0.010;    // largest time without a valid reading
    double ending_s = 0.010;  // fade when the program ends

    // A reading that stands still while the force changes. If the device's own time stamp stands
    // still too, after having run, any change of the force counts. Else the position must have
    // stood still for `frozen_s`, and then for as long under forces that differ by more than
    // `frozen_newton` from the mean before; time under smaller differences counts back a quarter,
    // so that forces that alternate count too. Twice the friction of 0.26 N is lost on turning
    // round, and the 1.48 N left move the stiffest thing that holds a handle, a stop of 20 N/mm
    // with a firm hand, by 0.07 mm, more than an encoder step of 0.055 mm; a firm hand of 0.5 N/mm
    // by 50 steps. Infinity for both on a device without motors.
    double frozen_s = 0.05;
    double frozen_newton = 2;

    // A contact model older than the larger of the first two is stale. The force then fades, to
    // zero when it is older than the larger of the others.
    double stale_periods = 1.5;
    double stale_s = 0.1;
    double dead_periods = 2;
    double dead_s = 0.2;

    // Motors: while the device says that they are warm the force fades in `cool_down_s`, and they
    // count as hot from then on. Once the leaky mean of F^2 over `heat_s` reaches
    // thermal_limit_newton^2, the clamp glides from what is sent to thermal_limit_newton, the force
    // that the motors stand for ever; once the mean is below `cooled_share` of that, it glides
    // back.
    double cool_down_s = 0.1;
    double thermal_limit_newton = 0.88;
    double heat_s = 30;
    double cooled_share = 0.8;
    double glide_s = 1;

    // Engaging: after more than `quiet_cycles` ticks in a row with |wanted force| < quiet_newton
    // the force rises to its full size in `ramp_s`.
    double quiet_newton = 0.2;
    int quiet_cycles = 3;
    double ramp_s = 2;
};

// A real device with motors is not run with a longer period of the simulation: for as long as two
// of them it plays the force of a simulation that has died.
inline constexpr double longest_real_period_s = 1;

// Whether the device may be used with this period.
bool supports_period(const DeviceSpec& device, double period_s) noexcept;

// Takes over what a device says of itself; nothing beside what the settings allow already. Without
// motors none can be seen to hang in its readings, and none grows hot.
void limit_to(const DeviceSpec& device, SafetySettings& settings) noexcept;

// From harmless to severe.
enum class SafetyStage {
    None,
    Slewed,
    Clamped,
    ThermalLimit,  // clamped below the normal limit because of warm motors
    Engaging,      // the ramp
    Waiting,       // waiting for quiet cycles
    Disengaged,    // off after disengage(), as during a pause
    Ending,
    Stale,     // contact model too old: the force fades or has faded
    CoolDown,  // the device reports warm motors: the force fades likewise
    TooFast,
    Late,  // tick too late, or the clock stopped, went back, or is not finite
    Frozen,
    Jump,
    Refused,  // the device switched the force off
    Unplugged,
    NotFinite
};

// What happened and what the user can do, for the window; empty for None.
std::string_view describe(SafetyStage stage) noexcept;

// The input of one tick.
struct SafetyInput {
    Vec3 wanted_newton = Vec3::Zero();
    DeviceReading reading;
    double now_s = 0;        // the servo's own monotonic clock
    double model_age_s = 0;  // age of the contact model, s; 0 before the first
    double period_s = 0;     // of the simulation
    Vec3 velocity_m_per_s = Vec3::Zero();
    bool is_ending = false;  // the program is ending
};

// The state between two ticks. A new state starts from the beginning.
struct SafetyState {
    SafetyState() noexcept;

    // non-finite
    bool not_finite = false;  // stays set until release()
    // clock
    double last_s = 0;
    bool has_clock = false;
    double stood_s = 0;  // without a tick of time; each tick counts as one
    std::array<std::uint32_t, slow_window_ticks> ticks_us;  // ring of the last tick lengths
    std::uint32_t ticks_sum_us = 0;
    std::size_t next_tick = 0;
    // reading
    Vec3 handle_m = Vec3::Zero();  // last valid handle position
    bool has_reading = false;
    double unread_s = std::numeric_limits<double>::infinity();  // since the last valid reading
    double stamp_s = 0;                // last valid time stamp of the device
    bool stamp_runs = false;           // whether the time stamp advances
    Vec3 hung_newton = Vec3::Zero();   // force sent when stamp or position last changed
    bool hung_changed = false;         // whether another force was sent since
    double hung_s = 0;                 // time since then
    double still_s = 0;                // time without change of position; up to frozen_s
    Vec3 still_newton = Vec3::Zero();  // mean force sent in that time
    double pushed_s = 0;               // the force has been `frozen_newton` away from it since
    // stale model
    double faded = 0;  // share of the fade done, 0 to 1
    // warm motors
    double cool_down_share = 0;  // share of the force removed because of warm motors, 0 to 1
    // end
    double ending_s = 0;  // time since the program began to end
    // heat
    double mean_square_newton2 = 0;  // leaky mean of the squared force
    bool is_thermally_limited = false;
    double limited_from_newton = 0;  // force sent when the thermal limit began
    double glided = 0;               // 0: normal limit, 1: limit at thermal_limit_newton
    // engaging
    enum class Engagement { Fresh, Off, Waiting, Rising, On };
    Engagement engagement = Engagement::Fresh;
    int quiet_cycles = 0;  // quiet ticks so far
    double risen = 0;      // share of the rise done, 0 to 1
    SafetyStage reason =
        SafetyStage::None;  // gravest that took the force away; None once it is back
    // sending
    Vec3 sent_newton = Vec3::Zero();
};

struct SafetyResult {
    Vec3 newton = Vec3::Zero();             // force to send
    SafetyStage stage = SafetyStage::None;  // most severe stage of this tick
    // Why the force has not fully returned, while it waits or rises; else None.
    SafetyStage reason = SafetyStage::None;
    double share = 1;  // share of the wanted force that passes fades and clamp; without slew
    // Share of the force that the thermal limit lets through. The molecule follows this share of
    // the handle's travel until the next tick, so that the limit is passive.
    double heat_share = 1;
};

// The force that may be sent in this tick. Whatever comes in, it is finite and its norm is not
// above the clamp. Not finite, jump, frozen, refused, late, too fast, unplugged: zero in the tick
// that finds it, whatever the slew; all other changes keep to the slew. What took the force to
// zero, once it is over, is followed by quiet cycles and ramp; a force that is no number only after
// release(). A late tick is found when it comes: what the device plays until then is up to its own
// watchdog. As late counts a clock that stands still for as many ticks as `late_s` has
// milliseconds. Never throws, locks, waits or allocates.
[[nodiscard]] SafetyResult guard_force(const SafetySettings& settings, SafetyState& state,
                                       const SafetyInput& input) noexcept;

// Takes the force away, within the slew limit, until engage(): for a pause. Clock and handle may
// stand still or jump in between. If no tick follows, the caller sends the zero.
void disengage(SafetyState& state) noexcept;

// After disengage(): the force returns after quiet cycles with a ramp. Otherwise no effect.
void engage(SafetyState& state) noexcept;

// Whether the force is off until release().
bool is_latched(const SafetyState& state) noexcept;

// Ends a latched stop; quiet cycles and ramp follow.
void release(SafetyState& state) noexcept;

}  // namespace palpa
