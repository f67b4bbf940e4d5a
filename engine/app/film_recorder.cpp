#include "app/film_recorder.h"

#include "core/load_error.h"
#include "core/translate.h"
#include "platform/thread.h"

#include <fmt/format.h>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

// Beyond that a picture stands for the next one too: writing takes longer than showing.
constexpr std::size_t most_waiting = 50;

}  // namespace

FilmRecorder::FilmRecorder(const FilmSettings& settings)
    : settings_(settings), film_(settings), thread_([this] { run(); }) {}

FilmRecorder::~FilmRecorder() {
    end();
    thread_.join();
}

double FilmRecorder::filmed_s() const { return static_cast<double>(taken_) / settings_.per_second; }

bool FilmRecorder::is_due() const {
    if (is_ended_ || waiting() >= most_waiting) return false;
    const std::chrono::duration<double> since = Clock::now() - start_;
    return since.count() * settings_.per_second >= static_cast<double>(taken_);
}

void FilmRecorder::add(Picture picture) {
    if (is_ended_) return;
    if (taken_ == 0) {
        width_ = picture.width;
        height_ = picture.height;
    }
    if (picture.width != width_ || picture.height != height_) return end();
    const std::chrono::duration<double> since = Clock::now() - start_;
    const auto due = static_cast<std::size_t>(std::floor(since.count() * settings_.per_second)) + 1;
    const std::size_t times = due > taken_ ? due - taken_ : 1;
    taken_ += times;
    {
        const std::lock_guard lock(mutex_);
        shots_.push_back({std::move(picture), times});
    }
    has_news_.notify_one();
}

void FilmRecorder::end() {
    is_ended_ = true;
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    has_news_.notify_one();
}

std::size_t FilmRecorder::waiting() const {
    const std::lock_guard lock(mutex_);
    return shots_.size();
}

std::optional<std::string> FilmRecorder::outcome() const {
    const std::lock_guard lock(mutex_);
    return outcome_;
}

void FilmRecorder::write_pictures() {
    for (;;) {
        Shot shot;
        {
            std::unique_lock lock(mutex_);
            has_news_.wait(lock, [this] { return is_over_ || !shots_.empty(); });
            if (shots_.empty()) return;
            shot = std::move(shots_.front());
            shots_.pop_front();
        }
        for (std::size_t i = 0; i < shot.times; ++i) film_.add(shot.picture);
    }
}

void FilmRecorder::run() {
    constexpr int behind_drawing = 10;
    lower_priority(behind_drawing);
    std::string said;
    try {
        write_pictures();
        const FilmEnd end = film_.finish();
        said = end.is_film ? format_translated("{}: a film of {} pictures", settings_.file.string(),
                                               film_.frame_count())
                           : format_translated("{}: {} pictures; {}", end.folder.string(),
                                               film_.frame_count(), end.why);
    } catch (const LoadError& error) {
        said = format_translated("no film: {}", error.what());
    }
    const std::lock_guard lock(mutex_);
    outcome_ = said;
}

}  // namespace palpa
