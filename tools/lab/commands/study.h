// palpa-lab study: the paper's experiment by emulated operators, and forced choices.
#pragma once
#include "tools/lab/experiments/forced_choice.h"

#include <filesystem>
#include <optional>

namespace palpa {

struct StudyCommand {
    ForcedChoiceOptions choice;  // and the study's
    bool is_choice = false;
    std::optional<std::filesystem::path> folder;
    bool json = false;
};

// Throws LoadError on bad input. Returns the exit code.
int forced_choice_command(const StudyCommand& command);

}  // namespace palpa
