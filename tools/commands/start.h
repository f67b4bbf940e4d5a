// palpa without a command: the scene of last time, or a list of the scenes.
#pragma once

namespace palpa {

// Opens the scene of last time where there is a display and it is still there; else prints the
// scenes that come with Palpa and how to open one. Returns the exit code. Throws LoadError, the
// scenes printed, where something is wrong with that one.
int start_command();

}  // namespace palpa
