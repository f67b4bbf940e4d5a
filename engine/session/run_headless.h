// Runs a whole scene without a window: loads it, runs the device in lockstep, sums up and records.
#pragma once
#include "core/stage.h"
#include "ecs/world.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "haptics/servo.h"
#include "scene/description.h"
#include "scene/edits.h"
#include "session/lockstep.h"
#include "session/recording.h"
#include "session/statistics.h"
#include "simulation/probe.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// Gets the completed share of the run, 0 to 1, about ten times per simulated second.
using ProgressFunction = std::function<void(double share)>;

// Draws frames of the simulation: one at its start and `per_second` in each simulated second.
struct FrameClock {
    double per_second = 0;
    std::function<void()> draw;
};

// Makes an edit at once, like the scene's own edits. Throws LoadError at the edit's place and then
// changes nothing.
using EditFunction = std::function<void(const EditDescription&)>;

// Called before each step and after the edits that are due; may make further edits.
using BeforeStepFunction = std::function<void(World&, const EditFunction& edit)>;

// Number of servo ticks of the scene's run.
std::uint64_t count_ticks(const SceneDescription& scene) noexcept;

// The device that the scene gives to a hand, as a device describes itself. `slot`, here and below:
// number of the hand, from 0.
DeviceSpec describe_emulated_device(const SceneDescription& scene, std::size_t slot);

// Servo settings of a hand for this device, or for the scene's own. A real device
// always has the whole safety chain, with the device's limits, and forces start after quiet cycles
// with a ramp; an emulated one has the whole chain only with guarded coupling.
ServoSettings build_servo_settings(const SceneDescription& scene, const World& world,
                                   std::size_t slot, const DeviceSpec& device);
ServoSettings build_servo_settings(const SceneDescription& scene, const World& world,
                                   std::size_t slot);

// Applies changes of the coupling by edits to the hands; their servos blend into the new values.
void renew_servos(const SceneDescription& scene, const World& world, std::span<LockstepHand> hands);

// Throws LoadError if the device must not run with this period of the simulation: a real device
// with motors and a period above `longest_real_period_s`.
void check_period(const DeviceSpec& device, double period_s);

// A_d of a hand's coupling (paper or guarded) for this force on the molecule (N) and stiffness
// (N/m).
double gain_where(const ServoSettings& servo, const CouplingLaws& laws, const Vec3& force_newton,
                  const Mat3& stiffness) noexcept;
// The same in one dimension.
double gain_where(const ServoSettings& servo, const CouplingLaws& laws,
                  const LineForce& line) noexcept;

// The place along the line where the hand feels the stiffest spring, K = A_f k_e / A_d, at up to
// the scene's peak force. In space k_e is replaced by the largest eigenvalue of sym(J k_e), with J
// the Jacobian of the force law at that norm of the force.
struct FeltStiffness {
    double newton_per_metre = 0;
    double angstrom = 0;
};
// `on_stage` hears how far the search is, which takes minutes for a large rigid molecule.
FeltStiffness stiffest_place(const SceneDescription& scene, const World& world,
                             const StageFunction& on_stage = {}, std::size_t slot = 0);

// The stiffest spring (N/m) that is passive with this hand, its device, this period and the
// scene's servo delay (haptics/plant.h); with guarded coupling at the period and damping of the
// servo.
double calm_stiffness(const SceneDescription& scene, std::size_t slot,
                      const std::optional<HandModel>& hand, double period_s);

// Warnings about the scene: a spring too stiff for this hand, device, period and servo delay
// (haptics/plant.h); with guarded coupling a position sensor too coarse for stiffness and damping,
// or gains that amplify rounding errors; overlapping atoms; molecules that are not at rest; a
// stroke longer than the run.
std::vector<std::string> list_warnings(const SceneDescription& scene, const World& world,
                                       const HandScript& script,
                                       const StageFunction& on_stage = {});

// The warnings that concern one further hand, `slot` ≥ 1.
std::vector<std::string> list_hand_warnings(const SceneDescription& scene, const World& world,
                                            const HandScript& script, std::size_t slot,
                                            const StageFunction& on_stage = {});

// Adds what went wrong during the run to the summary's warnings.
void warn_of_outcome(Summary& summary);

// Runs the scene for its seconds, or until `is_over`, called after every tick, returns true.
// `warnings` become the first warnings of the summary. `recording`, `progress` and `watch`, which
// gets every tick, may be null or empty; frames are optional. The world is left as the run ends it.
Summary run_headless(const SceneDescription& scene, World& world, Device& device,
                     const std::vector<std::string>& warnings, Recording* recording,
                     const ProgressFunction& progress, const FrameClock& frames = {},
                     const TickFunction& watch = {}, const EndFunction& is_over = {});

// The same with devices for several hands of the world, in the same order; hands without a device
// stand still.
Summary run_headless(const SceneDescription& scene, World& world, std::span<Device* const> devices,
                     const std::vector<std::string>& warnings, Recording* recording,
                     const ProgressFunction& progress, const FrameClock& frames = {},
                     const HandTicksFunction& watch = {}, const EndFunction& is_over = {},
                     const BeforeStepFunction& before_step = {});

}  // namespace palpa
