// The panel below the picture during playback of a trajectory.
#pragma once
#include "core/translate.h"
#include "session/commands.h"
#include "ui/layout.h"

#include <vector>

namespace palpa {

inline constexpr const char* playback_panel = for_translation("Trajectory");  // its title

// Describes the panel to the overlay library, in the middle of `area`: play and pause, frame,
// speed. Appends the person's requests.
void draw_playback_panel(const PlaybackState& state, const ScreenArea& area,
                         std::vector<Command>& commands);

// The orders for the keys "play, pause" and "from the beginning".
PlaybackOrder play_or_pause(const PlaybackState& state);
PlaybackOrder play_from_start();

}  // namespace palpa
