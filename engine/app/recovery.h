// Saves unsaved changes from time to time, in case the program ends unexpectedly.
#pragma once
#include "ecs/world.h"
#include "scene/description.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace palpa {

// The recovery file of one scene in one process. If it cannot be written, the next call tries
// again.
class RecoveryFile {
public:
    RecoveryFile();

    void save(const World& world, const ViewDescription& view) noexcept;
    // Deletes the file, after the person saved or discarded the changes.
    void forget() noexcept;

private:
    std::optional<std::filesystem::path> folder_, file_;
};

// Recovery files of programs that no longer run, newest first; they can be opened as scenes.
std::vector<std::filesystem::path> list_recovered();

// Whether the file is a recovery file. It names files that the scene reads by their full paths.
bool is_recovered(const std::filesystem::path& file);

// Removes it, with its atoms.
void forget_recovered(const std::filesystem::path& file) noexcept;

}  // namespace palpa
