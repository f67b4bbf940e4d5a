// What a long command is doing, on one line of a terminal.
#pragma once
#include "core/stage.h"

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

// Writes to standard error where that is a terminal and somebody wants it; never into a file or a
// pipe. The line is wiped when this goes, so make it before what it reports on.
class ProgressLine {
public:
    explicit ProgressLine(bool is_wanted = true);
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    ~ProgressLine();

    // Empty where nothing is shown. This must outlive it.
    StageFunction stages();
    // The same of one stage, given only its share.
    std::function<void(double share)> shares(std::string stage);

    // Before anything else is printed.
    void wipe();

private:
    void show(std::string_view stage, std::optional<double> share);

    bool is_shown_;
    bool has_line_ = false;
    std::string text_;  // on the line now
    std::chrono::steady_clock::time_point shown_{};
};

// How far a command is that plays many of one kind, "12 of 300", likewise.
class CountLine {
public:
    CountLine();

    void show(const std::string& text);
    // At the end, before anything else is printed.
    void wipe();

private:
    bool is_shown_;
};

}  // namespace palpa
