#include "core/load_error.h"

#include "core/text.h"

#include <fmt/format.h>

namespace palpa {

std::string to_string(const TextPlace& place) {
    if (place.line == 0) return place.file;
    if (place.column == 0) return fmt::format("{}:{}", place.file, place.line);
    return fmt::format("{}:{}:{}", place.file, place.line, place.column);
}

LoadError::LoadError(const TextPlace& place, const std::string& message)
    : std::runtime_error(printable(to_string(place) + ": " + message)) {}

}  // namespace palpa
