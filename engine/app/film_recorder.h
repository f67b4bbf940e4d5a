// Records a film of the window during a session: a thread writes the pictures and makes the film.
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

    // Begins to record. Throws LoadError as Film does.
    explicit FilmRecorder(const FilmSettings& settings);
    FilmRecorder(const FilmRecorder&) = delete;
    FilmRecorder& operator=(const FilmRecorder&) = delete;
    ~FilmRecorder();  // makes the film from the pictures so far

    // Whether a picture is due now.
    bool is_due() const;
    // Adds a picture, which also stands for those that were due since the last one. A picture of
    // another size ends the film.
    void add(Picture picture);
    // Ends recording and makes the film.
    void end();

    bool is_ended() const noexcept { return is_ended_; }
    double filmed_s() const;
    // Number of pictures not yet written.
    std::size_t waiting() const;
    // The outcome as a sentence, once it is known.
    std::optional<std::string> outcome() const;

private:
    struct Shot {
        Picture picture;
        std::size_t times = 1;
    };

    void run();
    void write_pictures();

    const FilmSettings settings_;
    Film film_;  // used by the thread
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
