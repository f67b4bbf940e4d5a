#include "formats/index_file.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <optional>

namespace palpa {

std::vector<IndexGroup> parse_index_file(std::string_view text, const std::string& file) {
    std::vector<IndexGroup> groups;
    for (LineReader lines(text); !lines.at_end(); lines.advance()) {
        const auto fail = [&](const std::string& what) {
            throw LoadError({file, lines.number()}, what);
        };
        const std::string_view line = trimmed(lines.line().substr(0, lines.line().find(';')));
        if (line.starts_with('[')) {
            const std::string_view name =
                line.ends_with(']') ? trimmed(line.substr(1, line.size() - 2)) : std::string_view{};
            if (name.empty()) {
                fail(fmt::format("'{}' is not the name of a group; expected \"[ name ]\"",
                                 shortened(line)));
            }
            groups.push_back({std::string(name), {}, lines.number()});
            continue;
        }
        for (const std::string_view word : split_words(line)) {
            if (groups.empty())
                fail("lists atoms before the first group; expected \"[ name ]\" first");
            const std::optional<std::int64_t> number = find_integer(word);
            constexpr std::int64_t most = 100'000'000;
            if (!number || *number < 1 || *number > most)
                fail(fmt::format("'{}' is not an atom number; expected a whole number from 1",
                                 shortened(word)));
            groups.back().atoms.push_back(static_cast<std::uint32_t>(*number - 1));
        }
    }
    if (groups.empty())
        throw LoadError({file}, "has no group; expected \"[ name ]\" and atom numbers");
    return groups;
}

std::vector<IndexGroup> read_index_file(const std::filesystem::path& path) {
    return parse_index_file(read_text_file(path), path.string());
}

}  // namespace palpa
