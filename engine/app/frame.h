// One frame of the window: a list of systems over the window's world (app/window_world.h), run in
// order. A new system is one function and one line in frame.cpp.
#pragma once
#include "app/run_window.h"
#include "app/window_world.h"
#include "ecs/world.h"

namespace palpa {

// The world of a window that shows this scene: nothing is drawn yet. `links` outlive it; `shell`
// may be null without a window.
World build_window_world(const WindowLinks& links, std::vector<WindowHand> hands);

// Shows frame after frame until the person leaves.
void run_frames(World& app);

// The report of the window when it closes.
WindowReport report_window(const World& app);

}  // namespace palpa
