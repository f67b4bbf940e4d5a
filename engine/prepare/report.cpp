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

std::string Report::to_plain_text() const {
    Report plain;
    for (const std::string& line : warnings_) plain.warn(without_options(line));
    for (const auto& [heading, lines] : sections_)
        for (const std::string& line : lines) plain.add(heading, without_options(line));
    return plain.to_text();
}

namespace {

// Finds an option of the command line, but no dashes within a file's name.
std::size_t find_option(std::string_view text) {
    for (std::size_t at = text.find("--"); at != text.npos; at = text.find("--", at + 2)) {
        const bool begins = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
        if (begins && at + 2 < text.size() && text[at + 2] >= 'a' && text[at + 2] <= 'z') return at;
    }
    return text.npos;
}

// Finds where the words after "--grab A:1: " begin, which say what is wrong with an option.
std::size_t find_reason(std::string_view text, std::size_t option) {
    const std::size_t colon = text.find(": ", option);
    if (colon == text.npos) return colon;
    const std::string_view named = text.substr(option, colon - option);
    return std::ranges::count(named, ' ') <= 1 ? colon + 2 : text.npos;
}

}  // namespace

std::string without_options(std::string_view text) {
    // Brackets with an option go, or their last clause does where one stands before it.
    std::string plain;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t open = text.find(" (", at);
        const std::size_t close = open == text.npos ? open : text.find(')', open);
        if (close == text.npos) {
            plain += text.substr(at);
            break;
        }
        const std::string_view inside = text.substr(open + 2, close - open - 2);
        plain += text.substr(at, open - at);
        std::size_t option = find_option(inside);
        if (option == inside.npos) {
            plain += text.substr(open, close + 1 - open);
        } else if (const std::size_t clause = inside.rfind("; ", option); clause != inside.npos) {
            plain += fmt::format(" ({})", inside.substr(0, clause));
        }
        at = close + 1;
    }
    // A clause with an option, up to the next one.
    for (std::size_t option; (option = find_option(plain)) != plain.npos;) {
        if (const std::size_t reason = find_reason(plain, option); reason != plain.npos) {
            plain.erase(option, reason - option);
            continue;
        }
        std::size_t begin = 0;
        for (const std::string_view mark : {"; ", ": ", ", or ", ", "}) {
            const std::size_t found = plain.rfind(mark, option);
            if (found != plain.npos) begin = std::max(begin, found);
        }
        // A purpose goes with its option: "; to charge it: --protonation A:12=HSP".
        const std::size_t clause = plain.rfind("; to ", option);
        if (clause != plain.npos && plain.find("; ", clause + 2) >= option) begin = clause;
        const std::size_t end = std::min(plain.find("; ", option), plain.size());
        plain.erase(begin, end - begin);
    }
    return plain;
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
