#include "tools/commands/progress.h"

#include "platform/terminal.h"

#include <fmt/format.h>
#include <cstddef>
#include <cstdio>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t width = 78;

}  // namespace

ProgressLine::ProgressLine(bool is_wanted) : is_shown_(is_wanted && is_terminal(stderr)) {}

ProgressLine::~ProgressLine() { wipe(); }

StageFunction ProgressLine::stages() {
    if (!is_shown_) return {};
    return [this](std::string_view stage, std::optional<double> share) { show(stage, share); };
}

std::function<void(double)> ProgressLine::shares(std::string stage) {
    if (!is_shown_) return {};
    return [this, stage = std::move(stage)](double share) { show(stage, share); };
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

CountLine::CountLine() : is_shown_(is_terminal(stderr)) {}

void CountLine::show(const std::string& text) {
    if (is_shown_) fmt::print(stderr, "\r{} ", text);
}

void CountLine::wipe() {
    if (is_shown_) fmt::print(stderr, "\r{:30}\r", "");
}

}  // namespace palpa
