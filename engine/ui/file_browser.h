// A dialog that looks for a file on disk.
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
    // `endings`: of the files that are wanted, in lower case (".pdb"); compressed ones (".pdb.gz")
    // are shown too. Begins in `folder`, or where it was before.
    void open(std::string title, std::vector<std::string> endings,
              const std::filesystem::path& folder);
    void close();
    bool is_open() const noexcept { return is_open_; }

    // Up and Down choose in the list, Enter opens what is chosen.
    void press(Key key);

    // Describes it to the overlay library. A file that was chosen: it is closed then.
    std::optional<std::filesystem::path> draw();

private:
    struct Entry {
        std::string name;
        bool is_folder;
    };

    void go_to(const std::filesystem::path& folder);
    std::optional<std::filesystem::path> choose(const std::filesystem::path& path);
    void draw_places();
    std::optional<std::filesystem::path> draw_entries();
    bool is_wanted(const std::filesystem::path& file) const;

    bool is_open_ = false;
    std::string title_;
    std::vector<std::string> endings_;
    std::filesystem::path folder_;
    std::string typed_;    // the path at the top
    std::string problem_;  // of the folder, or of what was typed
    std::vector<Entry> entries_;
    std::size_t chosen_ = 0;
    int steps_ = 0;            // down
    bool is_cut_off_ = false;  // the folder has more
    bool shows_all_ = false, wants_enter_ = false;
};

}  // namespace palpa
