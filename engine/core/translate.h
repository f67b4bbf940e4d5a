// Translates the texts of the window by GNU gettext catalogues, made from engine/ui/locale/*.po.
// Without a catalogue, without gettext (Windows) or without a translation the English text is used.
// Numbers have a decimal point in every language.
#pragma once
#include <fmt/format.h>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

// The translation of `english`, which must be a literal so that tools/scripts/update_translations
// finds it. The result stays valid.
[[gnu::format_arg(1)]] const char* translated(const char* english);

// The translation of the singular or plural form for this count.
const char* translated_plural(const char* one, const char* many, std::size_t count);

// Marks literals in tables that are translated where they are used.
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

// English and the languages with a catalogue beside the program.
std::vector<Language> list_languages();

// Chooses the language by its code; empty: by LANGUAGE, LC_ALL, LC_MESSAGES and LANG. Returns false
// if it is not available; the texts are English then, as before the first call. Call on the main
// thread while no other thread reads the environment.
bool choose_language(const std::string& code);

// The code of the present language.
std::string language_in_use();

}  // namespace palpa
