// Films: numbered pictures in a folder, of which ffmpeg makes one file where it is installed.
#pragma once
#include "core/files.h"
#include "render/picture.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace palpa {

struct FilmSettings {
    // ffmpeg knows the kind by its ending: .mp4, .mkv, .mov, .webm. Without an ending: a folder for
    // numbered pictures, and no film.
    std::filesystem::path file;
    double per_second = 25;   // pictures
    bool overwrites = false;  // a film, and pictures, that this program made before
};

// What became of it.
struct FilmEnd {
    bool is_done = false;          // what was asked for is there
    bool is_film = false;          // the file is there, and its pictures are gone
    std::filesystem::path folder;  // else where the pictures are
    std::string why;               // where it is not done: a sentence
};

// Pictures go to the folder FILE-frames, or FILE where it has no ending, 00000.png and on. One
// thread at a time.
class Film {
public:
    // Throws LoadError: another ending, a file or a folder that is there and not this program's to
    // replace.
    explicit Film(const FilmSettings& settings);

    // All of one size. Throws LoadError where it cannot be written.
    void add(const Picture& picture);
    std::size_t frame_count() const noexcept { return count_; }

    // Runs ffmpeg. What it cannot do leaves the pictures where they are.
    FilmEnd finish();

private:
    FilmSettings settings_;
    std::filesystem::path folder_;
    std::size_t count_ = 0;
};

// The same look before anything long is done. Throws LoadError as the constructor does.
void check_film(const FilmSettings& settings);

}  // namespace palpa
