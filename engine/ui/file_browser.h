// A dialog to choose a file on disk.
#pragma once
#include "window/window.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

class FileBrowser {
public:
    // `endings`: accepted file extensions in lower case (".pdb"); compressed files (".pdb.gz") are
    // shown too. Starts in `folder`, or in the folder of the last time.
    void open(std::string title, std::vector<std::string> endings,
              const std::filesystem::path& folder);
    void close();
    bool is_open() const noexcept { return is_open_; }

    // Up and Down move in the list, Enter opens the choice; letters go to the first name that
    // begins with them.
    void press(Key key);

    // The folder that is shown, or was shown last.
    const std::filesystem::path& folder() const noexcept { return folder_; }
    // The chosen entry's name; empty: there is none.
    std::string chosen() const;

    // Describes the dialog to the overlay library. Returns the chosen file and then closes the
    // dialog.
    std::optional<std::filesystem::path> draw();

private:
    struct Entry {
        std::string name, size;  // "12 kB"; empty: a folder
        bool is_folder;
    };

    void go_to(const std::filesystem::path& folder);
    std::optional<std::filesystem::path> choose(const std::filesystem::path& path);
    std::filesystem::path find_typed() const;
    void draw_places();
    void follow_typing(bool types_path);
    std::optional<std::filesystem::path> draw_entries();
    bool is_wanted(const std::filesystem::path& file) const;

    bool is_open_ = false;
    std::string title_;
    std::vector<std::string> endings_;
    std::filesystem::path folder_;
    std::string typed_;    // text of the path field
    std::string problem_;  // problem with the folder or with the typed path
    std::vector<Entry> entries_;
    std::size_t chosen_ = 0;
    int steps_ = 0;            // pending moves in the list, positive downwards
    std::string ahead_;        // letters typed so far for a name
    double typed_at_s_ = 0;    // when the last one was
    bool moved_ = false;       // the choice, by letters
    bool is_cut_off_ = false;  // the folder has more entries than shown
    bool shows_all_ = false, wants_enter_ = false;
};

}  // namespace palpa
