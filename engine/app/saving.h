// Saves the scene, asks before changes are lost, and leaves the window.
#pragma once
#include "app/run_window.h"
#include "ecs/world.h"

#include <optional>

namespace palpa {

// True if the scene's file, or the file saved last, has all that a person changed.
bool is_saved(const World& app);
// Saves to a new file; false if that fails or is not possible.
bool save_scene_in_window(World& app);
// Writes a copy now and then, so that a crash loses little; call once a frame.
void save_for_crash(World& app);
// Takes the present state as saved.
void note_saved(World& app);

// Leaves the window, after a question if something is not saved. `next`: the next screen; none: the
// program ends.
void ask_to_leave(World& app, std::optional<NextScreen> next);
void ask_to_quit(World& app);
void open_start_screen(World& app);

}  // namespace palpa
