#include "core/load_error.h"

#include "core/text.h"

#include <fmt/format.h>
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

}  // namespace palpa
