// A film of the window while a person works: pictures are written, and the film is made, beside.
#pragma once
#include "render/film.h"
#include "render/picture.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace palpa {

class FilmRecorder {
public:
    using Clock = std::chrono::steady_clock;

    // Begins now. Throws LoadError as Film does.
    explicit FilmRecorder(const FilmSettings& settings);
    FilmRecorder(const FilmRecorder&) = delete;
    FilmRecorder& operator=(const FilmRecorder&) = delete;
    ~FilmRecorder();  // makes the film of what there is

    // Whether a picture is wanted now.
    bool is_due() const;
    // It stands for all that were due since the last one. One of another size than the first ends
    // the film.
    void add(Picture picture);
    // No more pictures; the film is made.
    void end();

    bool is_ended() const noexcept { return is_ended_; }
    double filmed_s() const;
    // Pictures that have still to be written.
    std::size_t waiting() const;
    // What became of it, a sentence, once it is known.
    std::optional<std::string> outcome() const;

private:
    struct Shot {
        Picture picture;
        std::size_t times = 1;
    };

    void run();
    void write_pictures();

    const FilmSettings settings_;
    Film film_;  // the thread's
    const Clock::time_point start_ = Clock::now();
    std::size_t taken_ = 0;
    std::uint32_t width_ = 0, height_ = 0;
    bool is_ended_ = false;

    mutable std::mutex mutex_;
    std::condition_variable has_news_;
    std::deque<Shot> shots_;
    bool is_over_ = false;
    std::optional<std::string> outcome_;
    std::thread thread_;
};

}  // namespace palpa
