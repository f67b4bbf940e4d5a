// Coupling and period as a person sets them in the window, and what the servo reports of them.
#pragma once
#include "ecs/world.h"
#include "haptics/servo.h"
#include "scene/description.h"
#include "session/commands.h"

#include <vector>

namespace palpa {

// The smallest overtravel (m) that is reported.
inline constexpr double least_overtravel_m = 0.5e-3;

// Changes them here and in the session.
void change_settings(World& app, const LiveSettings& settings);
void set_mode(World& app, CouplingMode mode);
// Shows the settings of the hand that the mouse leads now.
void show_settings_of_led(World& app);
// Lists the settings of each hand.
std::vector<LiveSettings> list_hand_settings(const World& app);

// Computes the largest stiffness that is passive at the present settings.
void update_stiffness_limit(World& app);

// Takes over what undo, or a recorded session, has set; call once a frame.
void follow_settings(World& app);

// Takes out the servo's ticks since the last frame: statistics, readings, the lesson.
void take_ticks(World& app);
// One tick of the hand that the mouse leads.
void add_tick(World& app, const ServoTick& tick);

// True if the hand now feels a spring too stiff for passivity at the present period.
bool is_shaking(const World& app);
// The stiffness that the hand feels now, N/m.
double find_felt_stiffness(const World& app);

// Sets additions to the picture, here and in the session.
void set_additions(World& app, ViewAdditions additions);

}  // namespace palpa
