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
    const FileVersion last_of_major{ours.major + 1, 0};
    if (stated < unnumbered_version) {
        throw LoadError(place, fmt::format("{0} format {1} does not exist; expected {0} format 1 "
                                           "to {2}",
                                           kind, to_string(stated), to_string(ours)));
    }
    if (stated >= last_of_major) {
        throw LoadError(place, fmt::format("{0} format {1} is newer than this program, which reads "
                                           "{0} formats 1 to {2}; expected one of these, or a "
                                           "newer Palpa to read it with",
                                           kind, to_string(stated), to_string(ours)));
    }
    if (stated <= ours) return std::nullopt;
    return fmt::format("{} format {} is newer than {}, which this program writes: {}", kind,
                       to_string(stated), to_string(ours), of_unknown);
}

}  // namespace palpa
