#include "prepare/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <iterator>

namespace palpa {

void Report::add(std::string_view heading, std::string decision) {
    const auto found = std::find_if(sections_.begin(), sections_.end(),
                                    [&](const auto& section) { return section.first == heading; });
    if (found != sections_.end()) {
        found->second.push_back(std::move(decision));
    } else {
        sections_.emplace_back(heading, std::vector{std::move(decision)});
    }
}

void Report::warn(std::string decision) { warnings_.push_back(std::move(decision)); }

std::string Report::to_text() const {
    std::string text;
    const auto write = [&](std::string_view heading, const std::vector<std::string>& lines) {
        fmt::format_to(std::back_inserter(text), "{}\n", heading);
        for (const std::string& line : lines) {
            fmt::format_to(std::back_inserter(text), "  {}\n", line);
        }
        text += '\n';
    };
    if (!warnings_.empty()) write("Warnings: check these first", warnings_);
    for (const auto& [heading, lines] : sections_) write(heading, lines);
    return text;
}

std::string join_some(const std::vector<std::string>& names, std::string_view separator) {
    const std::size_t shown = std::min<std::size_t>(names.size(), 5);
    std::string text = fmt::format(
        "{}",
        fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), separator));
    if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
    return text;
}

}  // namespace palpa
