// A folder for what a command needs only while it works.
#pragma once
#include "core/interrupt.h"

#include <filesystem>

namespace palpa {

// A new folder among the temporary ones, gone with its owner; Ctrl+C ends the program only then.
// Throws LoadError where none can be made.
class WorkFolder {
public:
    WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;
    ~WorkFolder();

    const std::filesystem::path& path() const noexcept { return path_; }

private:
    HeldInterrupts held_;  // first, so that it goes last
    std::filesystem::path path_;
};

}  // namespace palpa
