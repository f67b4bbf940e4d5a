// A temporary folder for the duration of a command.
#pragma once
#include "core/interrupt.h"

#include <filesystem>

namespace palpa {

// Makes a new temporary folder and removes it at the end; Ctrl+C takes effect only after that.
// Throws LoadError if none can be made.
class WorkFolder {
public:
    WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder();

    const std::filesystem::path& path() const noexcept { return path_; }

private:
    HeldInterrupts held_;  // declared first, so that it is destroyed last
    std::filesystem::path path_;
};

}  // namespace palpa
