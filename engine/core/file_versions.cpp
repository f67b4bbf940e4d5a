#include "core/file_versions.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>

namespace palpa {

std::string to_string(FileVersion version) {
    return fmt::format("{}.{}", version.major, version.minor);
}

std::optional<FileVersion> find_version(std::string_view text) {
    constexpr std::int64_t most = 9999;
    const auto find_part = [](std::string_view part) -> std::optional<int> {
        const bool has_digits_only = part.find_first_not_of("0123456789") == std::string_view::npos;
        const std::optional<std::int64_t> number =
            has_digits_only ? find_integer(part) : std::nullopt;
        if (!number || *number > most) return std::nullopt;
        return static_cast<int>(*number);
    };
    const std::size_t dot = text.find('.');
    const std::optional<int> major = find_part(text.substr(0, dot));
    const std::optional<int> minor =
        dot == std::string_view::npos ? 0 : find_part(text.substr(dot + 1));
    if (!major || !minor) return std::nullopt;
    return FileVersion{*major, *minor};
}

std::string list_file_versions() {
    return fmt::format("scene {}, recording {}, journal {}", to_string(scene_version),
                       to_string(recording_version), to_string(journal_version));
}

std::optional<std::string> check_version(std::string_view kind, FileVersion stated,
                                         FileVersion ours, const TextPlace& place,
                                         std::string_view of_unknown) {
    if (stated.major != ours.major) {
        const bool is_newer = stated > ours;
        throw LoadError(place, fmt::format("{} format {} is {} than this program reads; expected "
                                           "format {}{}",
                                           kind, to_string(stated), is_newer ? "newer" : "older",
                                           to_string(ours),
                                           is_newer ? ", or a newer Palpa to read it with" : ""));
    }
    if (stated <= ours) return std::nullopt;
    return fmt::format("{} format {} is newer than {}, which this program writes: {}", kind,
                       to_string(stated), to_string(ours), of_unknown);
}

}  // namespace palpa
