#include "core/translate.h"

#include "platform/program.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#ifdef __GLIBC__
#include <libintl.h>
#include <clocale>
#include <cstdlib>
#include <optional>
#endif

namespace palpa {
namespace {

constexpr const char* english = "en";

}  // namespace

#ifdef __GLIBC__
namespace {

namespace fs = std::filesystem;

constexpr const char* domain = "palpa";

// Installed, or in a build; empty where there is none.
fs::path find_catalogues() {
    const fs::path program = find_program_file().parent_path();
    if (program.empty()) return {};
    for (const fs::path& below : {program / PALPA_SHARE, program.parent_path()}) {
        const fs::path folder = (below / "locale").lexically_normal();
        std::error_code error;
        if (fs::is_directory(folder, error)) return folder;
    }
    return {};
}

const fs::path& catalogues() {
    static const fs::path folder = find_catalogues();
    return folder;
}

bool has_catalogue(const std::string& code) {
    std::error_code error;
    return !catalogues().empty() &&
           fs::exists(catalogues() / code / "LC_MESSAGES" / "palpa.mo", error);
}

// LANGUAGE as the program was started with it.
const std::optional<std::string>& first_wish() {
    static const std::optional<std::string> wish = [] {
        const char* const value = std::getenv("LANGUAGE");
        return value ? std::optional<std::string>(value) : std::nullopt;
    }();
    return wish;
}

void set_wish(const std::optional<std::string>& wish) {
    wish ? setenv("LANGUAGE", wish->c_str(), 1) : unsetenv("LANGUAGE");
    // The library looks for catalogues anew once the locale has changed.
    std::setlocale(LC_MESSAGES, "C");
}

bool is_plain(const char* locale) {
    return !locale || std::string_view(locale) == "C" || std::string_view(locale) == "POSIX";
}

void follow_environment() {
    set_wish(first_wish());
    // English has no catalogue, and languages behind it in the list are not meant before it.
    if (first_wish() && first_wish()->starts_with("en")) return;
    std::setlocale(LC_MESSAGES, "");
}

void follow_choice(const std::string& code) {
    set_wish(code);
    if (code == english) return;
    // In the plain locale the library translates nothing, whatever is wanted.
    if (is_plain(std::setlocale(LC_MESSAGES, ""))) std::setlocale(LC_MESSAGES, "C.UTF-8");
}

}  // namespace

const char* translated(const char* text) {
    return *text == '\0' ? text : dgettext(domain, text);  // "" is the catalogue's header
}

const char* translated_plural(const char* one, const char* many, std::size_t count) {
    return dngettext(domain, one, many, count);
}

bool choose_language(const std::string& code) {
    (void)first_wish();
    if (!catalogues().empty()) {
        bindtextdomain(domain, catalogues().c_str());
        bind_textdomain_codeset(domain, "UTF-8");
    }
    code.empty() ? follow_environment() : follow_choice(code);
    return code.empty() || language_in_use() == code;
}

#else

namespace {

bool has_catalogue(const std::string& /*code*/) { return false; }

}  // namespace

const char* translated(const char* text) { return text; }

const char* translated_plural(const char* one, const char* many, std::size_t count) {
    return count == 1 ? one : many;
}

bool choose_language(const std::string& code) { return code.empty() || code == english; }

#endif

std::vector<Language> list_languages() {
    std::vector<Language> languages{{english, "English"}, {"de", "Deutsch"}};
    std::erase_if(languages, [](const Language& language) {
        return language.code != english && !has_catalogue(language.code);
    });
    return languages;
}

// A catalogue translates the code of English by its own.
std::string language_in_use() { return translated("en"); }

}  // namespace palpa
