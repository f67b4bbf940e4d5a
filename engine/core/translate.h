// The window's words in the language of whoever looks at it: catalogues of GNU gettext, made of
// engine/ui/locale/*.po. Where there is no catalogue, no gettext (Windows) or no translation of a
// text, the English text is used. Numbers keep their decimal point in every language.
#pragma once
#include <fmt/format.h>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

// `english` must be a literal, so that tools/scripts/update_translations finds it. What is returned
// stays valid.
[[gnu::format_arg(1)]] const char* translated(const char* english);

// One form of the two, or of as many as the language has, for that count.
const char* translated_plural(const char* one, const char* many, std::size_t count);

// Marks the literals of a table, which are translated where they are used.
constexpr const char* for_translation(const char* english) { return english; }

// fmt::format with a translated format; the English one is checked by the compiler, the others by
// tests/tools/translations_test.py.
template <typename... Args>
std::string format_translated(fmt::format_string<Args...> english, Args&&... args) {
    const fmt::string_view text = english;
    return fmt::format(fmt::runtime(translated(text.data())), std::forward<Args>(args)...);
}

struct Language {
    std::string code, name;  // "de", "Deutsch"
};

// English, and those whose catalogues are beside the program.
std::vector<Language> list_languages();

// By its code; empty: as LANGUAGE, LC_ALL, LC_MESSAGES and LANG say. False where it cannot be had:
// the texts are English then. Until the first call they are English. On the main thread, while
// nothing else reads the environment.
bool choose_language(const std::string& code);

// The code of the present one.
std::string language_in_use();

}  // namespace palpa
