// What one window shows, one after the other: the start screen, scenes, structures that are opened.
#pragma once
#include "app/preferences.h"
#include "app/run_window.h"
#include "app/window_shell.h"
#include "tools/commands/run.h"

#include <optional>

namespace palpa {

// A window of its own with the start screen, or with files: a scene, or a structure or the code of
// one and parameters of its ligands; the start screen says what is wrong with them. Returns the
// exit code. Throws PlatformError, GpuError.
int open_screens(const NextScreen& first, const RunOptions& options = {});

// From a scene on, in a window that is open, until the person quits.
void follow_screens(std::optional<WindowShell>& shell, PreferencesFile& preferences,
                    const RunOptions& options, std::optional<NextScreen> next);

}  // namespace palpa
