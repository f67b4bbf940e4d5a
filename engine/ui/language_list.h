// The window's languages to choose from, each called as those who speak it call it.
#pragma once
#include "core/translate.h"

#include <optional>
#include <span>
#include <string>

namespace palpa {

// Describes the list to the overlay library; the code of the language that was chosen. Where there
// is only one there is no list.
std::optional<std::string> draw_language_list(std::span<const Language> languages);

}  // namespace palpa
