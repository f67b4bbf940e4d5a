// The panel under the picture while a trajectory or a recorded session is played.
#pragma once
#include "core/translate.h"
#include "session/commands.h"
#include "ui/layout.h"
#include "ui/shortcuts.h"

#include <vector>

namespace palpa {

inline constexpr const char* playback_panel = for_translation("Trajectory");  // its title

// Describes the panel to the overlay library, in the middle of `area`: play and pause, frame,
// speed. Appends the person's requests.
void draw_playback_panel(const PlaybackState& state, const ScreenArea& area,
                         std::vector<Command>& commands);

inline constexpr const char* replay_panel = for_translation("Recorded session");

// The same of a recorded session.
void draw_replay_panel(const ReplayState& state, const ScreenArea& area,
                       std::vector<Command>& commands, std::vector<Action>& actions);

// What the key of "play, pause" and that of "from the beginning" ask for.
PlaybackOrder play_or_pause(const PlaybackState& state);
PlaybackOrder play_from_start();

}  // namespace palpa
