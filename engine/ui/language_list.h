// The list of the window's languages, each with its own name for itself.
#pragma once
#include "core/translate.h"

#include <optional>
#include <span>
#include <string>

namespace palpa {

// Describes the list to the overlay library; returns the code of a newly chosen language. With a
// single language there is no list.
std::optional<std::string> draw_language_list(std::span<const Language> languages);

}  // namespace palpa
