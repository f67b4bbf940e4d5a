#include "core/load_error.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

namespace palpa {

std::string to_string(const TextPlace& place) {
    if (place.line == 0) return place.file;
    if (place.column == 0) return fmt::format("{}:{}", place.file, place.line);
    return fmt::format("{}:{}:{}", place.file, place.line, place.column);
}

LoadError::LoadError(const TextPlace& place, const std::string& message)
    : LoadError(place, message, {}) {}

LoadError::LoadError(const TextPlace& place, const std::string& message,
                     std::vector<std::string> further)
    : std::runtime_error(printable(to_string(place) + ": " + message)),
      further_(std::make_shared<const std::vector<std::string>>(std::move(further))) {}

LoadError join_problems(const TextPlace& place, const std::vector<std::string>& problems,
                        const std::vector<std::string>& advice) {
    const auto named = problems.begin() +
                       static_cast<std::ptrdiff_t>(std::min(problems.size(), most_named_problems));
    std::vector<std::string> parts(problems.begin(), named), further(named, problems.end());
    if (!further.empty()) parts.push_back(fmt::format("and {} more", further.size()));
    parts.insert(parts.end(), advice.begin(), advice.end());
    return {place, fmt::format("{}", fmt::join(parts, "; ")), std::move(further)};
}

}  // namespace palpa
