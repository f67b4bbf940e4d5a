// Downloads a PDB entry in the window: a field for its code, and the download with its progress.
#pragma once
#include "app/preferences.h"
#include "app/run_window.h"
#include "app/window_shell.h"
#include "download/entry.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// Names what these open, from a command or dropped: of a code or a link that is no file, its PDB
// entry.
NextScreen name_screen(std::vector<std::filesystem::path> named);

// The server, limits and cache that the preferences name. Throws LoadError if these cannot be read
// or there is no cache folder.
EntrySource find_entry_source(const PreferencesFile& preferences);

// Nothing if the person cancelled. Throws LoadError.
std::optional<FetchedEntry> fetch_structure(WindowShell& shell, const PreferencesFile& preferences,
                                            const std::string& code);

// One sentence for the person, as describe() has it in English.
std::string translated_description(const FetchedEntry& entry);

// The field on the start screen.
class CodeField {
public:
    // The keyboard goes to the field.
    void focus() noexcept { wants_focus_ = true; }
    // Enter was pressed in the field; the library misses a short press between two pictures.
    void enter() noexcept { is_entered_ = true; }
    // Describes field and button to the overlay library. Returns the code that was asked for.
    std::optional<std::string> draw();
    // The code in the clipboard, a code or a link; says in the field if there is none.
    std::optional<std::string> paste();

private:
    std::optional<std::string> read(const std::string& text);

    std::string typed_, problem_;
    bool wants_focus_ = false, is_entered_ = false;
};

}  // namespace palpa
