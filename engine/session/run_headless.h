// A whole scene without a window: loaded, felt by a device in lockstep, summed up, recorded.
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

// Share of the run that is done, 0 to 1; called about ten times a simulated second.
using ProgressFunction = std::function<void(double share)>;

// Draws a frame of the simulation as it stands, `per_second` times a simulated second and at its
// start.
struct FrameClock {
    double per_second = 0;
    std::function<void()> draw;
};

// Makes an edit at once, as those of the scene are made. Throws LoadError at its place, and leaves
// all as it was.
using EditFunction = std::function<void(const EditDescription&)>;

// Called before each step, after the edits that are due; may make more.
using BeforeStepFunction = std::function<void(World&, const EditFunction& edit)>;

// Servo ticks of the scene's run.
std::uint64_t count_ticks(const SceneDescription& scene) noexcept;

// For an emulated device, whose safety chain is the whole one in guarded coupling alone.
// `half_workspace_m`: of the device, for what carries a small one over a large scene.
ServoSettings build_servo_settings(const SceneDescription& scene, const World& world,
                                   const Vec3& half_workspace_m = Vec3::Constant(0.1));

// For this device. The whole safety chain guards a real one in every mode, within its limits, and
// it engages by quiet cycles and ramp.
ServoSettings build_servo_settings(const SceneDescription& scene, const World& world,
                                   const DeviceSpec& device);

// Gives the hands what edits have made of the coupling; their servos glide to it.
void renew_servos(const World& world, std::span<LockstepHand> hands);

// Throws LoadError where this device must not be run with that period of the simulation: a real one
// with motors, beyond `longest_real_period_s`.
void check_period(const DeviceSpec& device, double period_s);

// A_d of the scene's coupling, the paper's or guarded, where the molecule feels this force (N) and
// stiffness (N/m).
double gain_where(const ServoSettings& servo, const World& world, const Vec3& force_newton,
                  const Mat3& stiffness) noexcept;
// The same on a line.
double gain_where(const ServoSettings& servo, const World& world, const LineForce& line) noexcept;

// Where along the line the hand feels the stiffest spring, K = A_f k_e / A_d, up to the scene's
// peak force: in space the largest eigenvalue of sym(J k_e)/A_d, J the Jacobian of the force law on
// the norm of the force.
struct FeltStiffness {
    double newton_per_metre = 0;
    double angstrom = 0;
};
// `on_stage` hears how far the look has got, which takes minutes where a large molecule is rigid.
// `slot`: of the hand, 0 the first.
FeltStiffness stiffest_place(const SceneDescription& scene, const World& world,
                             const StageFunction& on_stage = {}, std::size_t slot = 0);

// The stiffest spring (N/m) that this hand on the scene's device keeps calm at that period and the
// scene's servo delay (haptics/plant.h); guarded, at the servo's own period and with its damping.
double calm_stiffness(const SceneDescription& scene, const std::optional<HandModel>& hand,
                      double period_s);

// In words, what about the scene makes trouble: a spring stiffer than this hand, device, period and
// servo delay keep calm (haptics/plant.h); guarded, a position sensor too coarse for stiffness and
// damping, or gains that play rounding errors; atoms on each other, molecules that are not at rest,
// a stroke longer than the run.
std::vector<std::string> list_warnings(const SceneDescription& scene, const World& world,
                                       const HandScript& script,
                                       const StageFunction& on_stage = {});

// What of that is of a further hand alone, `slot` 1 and on.
std::vector<std::string> list_hand_warnings(const SceneDescription& scene, const World& world,
                                            const HandScript& script, std::size_t slot,
                                            const StageFunction& on_stage = {});

// Adds to the summary's warnings what went wrong in it.
void warn_of_outcome(Summary& summary);

// `warnings` are put at the head of the summary's. `recording`, `progress` and `watch`, which sees
// every tick, may be null or empty, and there need not be frames. It ends after the scene's
// seconds, or where `is_over`, asked after every tick, says so; the simulation ends where the run
// leaves it.
Summary run_headless(const SceneDescription& scene, World& world, Device& device,
                     const std::vector<std::string>& warnings, Recording* recording,
                     const ProgressFunction& progress, const FrameClock& frames = {},
                     const TickFunction& watch = {}, const EndFunction& is_over = {});

// The same with devices for the hands of the world, in their order; hands beyond these stand still.
Summary run_headless(const SceneDescription& scene, World& world, std::span<Device* const> devices,
                     const std::vector<std::string>& warnings, Recording* recording,
                     const ProgressFunction& progress, const FrameClock& frames = {},
                     const HandTicksFunction& watch = {}, const EndFunction& is_over = {},
                     const BeforeStepFunction& before_step = {});

}  // namespace palpa
