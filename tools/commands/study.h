// palpa study: the paper's experiment, done by emulated operators or by people, and forced choices.
#pragma once
#include "experiments/forced_choice.h"

#include <filesystem>
#include <optional>

namespace palpa {

struct StudyCommand {
    ForcedChoiceOptions choice;  // and the study's
    bool is_choice = false;
    std::optional<std::filesystem::path> folder;
    bool json = false;
    bool validation = false;  // of a person's window
};

// Each throws LoadError on bad input and returns the exit code.

int forced_choice_command(const StudyCommand& command);

// A person takes part, in a window: adds their trials to the folder's table, each as soon as it is
// done; session.json beside it has the settings. Throws LoadError also without a folder or where
// its trials have other settings, PlatformError without a display.
int study_in_window(const StudyCommand& command);

}  // namespace palpa
