// palpa replay: a recorded session played again, and held against what was recorded.
#pragma once
#include <filesystem>
#include <optional>

namespace palpa {

struct ReplayOptions {
    std::filesystem::path recording;  // folder
    bool verify = false;              // else one of the emulated hand is only played
    bool json = false;
    bool window = false;
    std::optional<double> trajectory_fps;  // writes the atoms of a window's recording
    bool trajectory_xtc = false;           // as XTC too
};

// Throws LoadError on bad input. Returns the exit code: 1 where a force or anything else that was
// recorded is not what is found again.
int replay_command(const ReplayOptions& options);

}  // namespace palpa
