// Messages for the person: one at a time in the status bar, all in its history; and the warnings
// that last as long as their reason.
#pragma once
#include "ecs/world.h"

#include <string>
#include <vector>

namespace palpa {

inline constexpr double notice_s = 4, long_notice_s = 15;

// Shows a message for so long, s.
void tell(World& app, std::string text, double seconds = notice_s);

// Tells what a new frame has of grips, undo and edits.
void tell_news(World& app);

// The warnings of this moment, each for two seconds after its reason has gone; call once a frame.
std::vector<std::string> list_warnings(World& app);
// The message that is shown now: a notice, or else what the hand can do.
std::string find_message(const World& app);

}  // namespace palpa
