#include "render/film.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/work_folder.h"
#include "platform/program.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view film_mark = "Made by Palpa";
constexpr std::array<std::string_view, 4> film_endings{".MP4", ".MKV", ".MOV", ".WEBM"};

bool is_sequence(const fs::path& film) { return film.extension().empty(); }

fs::path folder_of(const fs::path& film) {
    fs::path folder = film;
    if (!is_sequence(film)) folder += "-frames";
    return folder;
}

bool is_there(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

// ffmpeg writes the comment near the beginning or the end, as the kind of file has it.
bool is_own_film(const fs::path& path) {
    if (has_mark(path, film_mark)) return true;
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(path, error))) return false;
    constexpr std::streamoff most = 4096;
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream.tellg();
    std::string end(static_cast<std::size_t>(std::clamp<std::streamoff>(size, 0, most)), ' ');
    stream.seekg(std::max<std::streamoff>(size - most, 0));
    stream.read(end.data(), static_cast<std::streamsize>(end.size()));
    return end.find(film_mark) != std::string::npos;
}

bool is_own_frame(const fs::path& path) {
    const std::string stem = path.stem().string();
    return path.extension() == ".png" && !stem.empty() &&
           stem.find_first_not_of("0123456789") == std::string::npos &&
           has_mark(path, picture_mark);
}

// What stands there before; throws where any of it is somebody's.
std::vector<fs::path> list_frames(const fs::path& folder, bool overwrites) {
    if (!is_there(folder)) return {};
    std::error_code error;
    if (!fs::is_directory(fs::symlink_status(folder, error)))
        throw LoadError({folder.string()}, "is not a folder; expected one for the film's pictures");
    std::vector<fs::path> frames = list_folder(folder);
    if (frames.empty()) return frames;
    if (!overwrites || !std::ranges::all_of(frames, is_own_frame)) {
        throw LoadError({folder.string()},
                        overwrites ? "contains files that are not pictures of a film and is not "
                                     "replaced; expected another name for the film"
                                   : "is the folder for the film's pictures and is not empty; "
                                     "expected another name for the film, or --overwrite");
    }
    return frames;
}

// The first of its lines that says something.
std::string first_line_of(const fs::path& file) {
    std::ifstream stream(file);
    std::string line;
    while (std::getline(stream, line)) {
        if (!trimmed(line).empty()) return printable(trimmed(line));
    }
    return "it gives no reason";
}

// ffmpeg takes "%" in the name of numbered pictures for a number.
std::string escaped(std::string_view name) {
    std::string text;
    for (const char c : name) text += c == '%' ? std::string("%%") : std::string(1, c);
    return text;
}

}  // namespace

void check_film(const FilmSettings& settings) {
    if (is_sequence(settings.file)) {
        (void)list_frames(settings.file, settings.overwrites);
        return;
    }
    const std::string ending = upper_case(settings.file.extension().string());
    if (std::ranges::find(film_endings, ending) == film_endings.end()) {
        throw LoadError({settings.file.string()},
                        fmt::format("'{}' is not the ending of a film; expected .mp4, .mkv, .mov "
                                    "or .webm, or a folder for its pictures",
                                    settings.file.extension().string()));
    }
    if (is_there(settings.file) && !(settings.overwrites && is_own_film(settings.file))) {
        throw LoadError(
            {settings.file.string()},
            settings.overwrites
                ? "was not made by this program and is not replaced; expected another name"
                : "already exists; expected another name, or --overwrite");
    }
    (void)list_frames(folder_of(settings.file), settings.overwrites);
}

Film::Film(const FilmSettings& settings) : settings_(settings), folder_(folder_of(settings.file)) {
    check_film(settings);
    std::error_code error;
    for (const fs::path& frame : list_frames(folder_, settings.overwrites))
        fs::remove(frame, error);
    make_folder(folder_);
}

void Film::add(const Picture& picture) {
    write_png(folder_ / fmt::format("{:05}.png", count_), picture);
    ++count_;
}

FilmEnd Film::finish() {
    FilmEnd end;
    end.folder = folder_;
    if (count_ == 0) {
        end.why = "no picture was drawn";
        return end;
    }
    if (is_sequence(settings_.file)) {
        end.is_done = true;
        return end;
    }
    const WorkFolder work;
    fs::path made = folder_ / "film";
    made += settings_.file.extension();
    // Most players want an even number of pixels either way, and colours at half of it.
    const ProgramEnd ffmpeg = run_program(
        {"ffmpeg", "-loglevel", "error", "-framerate", fmt::format("{}", settings_.per_second),
         "-i", "file:" + escaped(folder_.string()) + "/%05d.png", "-vf",
         "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", "-metadata",
         fmt::format("comment={}", film_mark), "file:" + made.string()},
        work.path() / "output", work.path() / "errors");
    std::error_code error;
    if (ffmpeg.problem != 0 || ffmpeg.status != 0) {
        end.why = ffmpeg.problem != 0 ? "ffmpeg is not installed; install it to make a film of them"
                                      : fmt::format("ffmpeg failed to make a film of them: {}",
                                                    first_line_of(work.path() / "errors"));
        fs::remove(made, error);
        return end;
    }
    // Somebody may have put a file there meanwhile.
    if (is_there(settings_.file) && !(settings_.overwrites && is_own_film(settings_.file))) {
        end.why = fmt::format("{} already exists", settings_.file.string());
        fs::remove(made, error);
        return end;
    }
    fs::rename(made, settings_.file, error);
    if (error) {
        end.why = fmt::format("{} cannot be written: {}", settings_.file.string(), error.message());
        fs::remove(made, error);
        return end;
    }
    for (std::size_t i = 0; i < count_; ++i)
        fs::remove(folder_ / fmt::format("{:05}.png", i), error);
    fs::remove(folder_, error);
    end.is_film = end.is_done = true;
    return end;
}

}  // namespace palpa
