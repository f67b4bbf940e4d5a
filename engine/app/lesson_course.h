// The lesson of the scene in the window: its steps, their views, its restart.
#pragma once
#include "ecs/world.h"
#include "haptics/servo.h"

namespace palpa {

// Takes over what the session has measured, and shows the view that a new step names; call once a
// frame.
void follow_lesson(World& app);
// Counts a tick for the present step; nothing while a restart is awaited, or of an empty hand.
void follow_lesson_by_tick(World& app, const ServoTick& tick);

// Steps, what they measured, the world and the coupling's mode are as at the start.
void restart_lesson(World& app);
// Goes to the next step if the present one is done; after the last one, to the next lesson.
void go_on_in_lesson(World& app);
void skip_step(World& app);

}  // namespace palpa
