// palpa relax: brings the flexible molecules of a scene to rest and writes where they are then.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct RelaxOptions {
    std::filesystem::path scene;
    std::optional<std::filesystem::path> coordinates;  // to write
    std::vector<std::string> settings;
    bool overwrites = false;  // an earlier file of this command
    bool json = false;
};

// Throws LoadError on bad input. Returns the exit code: 1 where the molecules did not come to rest.
int relax_command(const RelaxOptions& options);

}  // namespace palpa
