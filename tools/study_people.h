// palpa study without operators: a person takes part, in a window.
#pragma once
#include "tools/study.h"

namespace palpa {

// Adds a person's trials to the folder's table, each as soon as it is done; session.json beside it
// has the settings. Throws LoadError, also without a folder or where its trials have other
// settings, PlatformError without a display. Returns the exit code.
int study_in_window(const StudyOptions& options);

}  // namespace palpa
