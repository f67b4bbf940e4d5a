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
    double per_second = 25;   // pictures per second
    bool overwrites = false;  // replaces a film and pictures that this program made before
};

// The result of a film.
struct FilmEnd {
    bool is_done = false;          // the requested result exists
    bool is_film = false;          // the film file exists, and its pictures were removed
    std::filesystem::path folder;  // otherwise the folder with the pictures
    std::string why;               // the reason of a failure, a sentence
};

// Pictures go to the folder FILE-frames, or FILE where it has no ending, 00000.png and on. One
// thread at a time.
class Film {
public:
    // Throws LoadError: another ending, a file or a folder that is there and not this program's to
    // replace.
    explicit Film(const FilmSettings& settings);

    // Adds a picture; all must have the same size. Throws LoadError if it cannot be written.
    void add(const Picture& picture);
    std::size_t frame_count() const noexcept { return count_; }

    // Runs ffmpeg. If that fails the pictures stay.
    FilmEnd finish();

private:
    FilmSettings settings_;
    std::filesystem::path folder_;
    std::size_t count_ = 0;
};

// Checks the settings before long work. Throws LoadError as the constructor does.
void check_film(const FilmSettings& settings);

}  // namespace palpa
