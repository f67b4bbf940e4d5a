// What a person changed and did not save, kept now and then in case the program ends unasked.
#pragma once
#include "scene/description.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace palpa {

// Of one scene in one process. Where it cannot be written it is tried again the next time; nobody
// is asked.
class RecoveryFile {
public:
    RecoveryFile();

    void save(const SceneDescription& scene) noexcept;
    // The person saved it, or left it as they wanted; otherwise the file stays.
    void forget() noexcept;

private:
    std::optional<std::filesystem::path> folder_, file_;
};

// Those that programs left that no longer run, the newest first: scenes that can be opened.
std::vector<std::filesystem::path> list_recovered();

// Whether it is one of these: it names files elsewhere, by their whole paths.
bool is_recovered(const std::filesystem::path& file);

// Removes it.
void forget_recovered(const std::filesystem::path& file) noexcept;

}  // namespace palpa
