#include "core/shell_word.h"

namespace palpa {

std::string shell_word(std::string_view word) {
    const std::string text = (word.starts_with('-') ? "./" : "") + std::string(word);
    if (!text.empty() && text.find_first_of(" \t()[]{}<>&|;'\"$`!*?#~\\") == std::string::npos)
        return text;
    // Double quotes, which every shell has, where nothing in them is special.
    if (text.find_first_of("\"$`!") == std::string::npos) return '"' + text + '"';
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

}  // namespace palpa
