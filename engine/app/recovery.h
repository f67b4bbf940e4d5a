// What a person changed and did not save, kept now and then in case the program ends unasked.
#pragma once
#include "scene/description.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace palpa {

// Of one scene in one process; gone when it ends as it should. What cannot be written is not kept,
// and nobody is disturbed by that.
class RecoveryFile {
public:
    RecoveryFile();
    RecoveryFile(const RecoveryFile&) = delete;
    RecoveryFile& operator=(const RecoveryFile&) = delete;
    ~RecoveryFile();

    void save(const SceneDescription& scene) noexcept;

private:
    std::optional<std::filesystem::path> file_;
};

// Those that programs left that no longer run, the newest first: scenes that can be opened.
std::vector<std::filesystem::path> list_recovered();

// Whether it is one of these: it names files elsewhere, by their whole paths.
bool is_recovered(const std::filesystem::path& file);

}  // namespace palpa
