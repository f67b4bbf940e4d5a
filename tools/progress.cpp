#include "tools/progress.h"

#include <fmt/format.h>
#include <unistd.h>
#include <cstddef>
#include <cstdio>

namespace palpa {
namespace {

constexpr std::size_t width = 78;

}  // namespace

ProgressLine::ProgressLine(bool is_wanted) : is_shown_(is_wanted && isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { wipe(); }

StageFunction ProgressLine::stages() {
    if (!is_shown_) return {};
    return [this](std::string_view stage, std::optional<double> share) { show(stage, share); };
}

void ProgressLine::wipe() {
    if (!has_line_) return;
    std::fputs(fmt::format("\r{:{}}\r", "", width).c_str(), stderr);
    std::fflush(stderr);
    has_line_ = false;
    text_.clear();
}

void ProgressLine::show(std::string_view stage, std::optional<double> share) {
    const std::string text =
        share ? fmt::format("{} {:3.0f} %", stage, 100 * *share) : fmt::format("{} ...", stage);
    // Another stage is shown at once, how far the same one is ten times a second.
    const auto now = std::chrono::steady_clock::now();
    const bool is_same_stage = text_.starts_with(stage);
    if (text == text_ || (is_same_stage && now - shown_ < std::chrono::milliseconds(100))) return;
    std::fputs(fmt::format("\r{:{}.{}}", text, width, width).c_str(), stderr);
    std::fflush(stderr);
    has_line_ = true;
    text_ = text;
    shown_ = now;
}

}  // namespace palpa
