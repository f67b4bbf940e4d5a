// The report of a preparation: its decisions, for people to check.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {

// Decisions under headings, both in order of arrival.
class Report {
public:
    void add(std::string_view heading, std::string decision);

    // Warnings that a user should check before using the system; also printed separately.
    void warn(std::string decision);

    const std::vector<std::string>& warnings() const noexcept { return warnings_; }

    // The whole report: warnings first, then each heading with its lines.
    std::string to_text() const;

    // The same for a window, without what it says of options (without_options).
    std::string to_plain_text() const;

private:
    std::vector<std::pair<std::string, std::vector<std::string>>> sections_;
    std::vector<std::string> warnings_;
};

// A line or a message without what it says of options of the command line: "(--keep-waters keeps
// them)" and clauses with such.
std::string without_options(std::string_view text);

// The first five of some names, and how many more there are.
std::string join_some(const std::vector<std::string>& names, std::string_view separator = ", ");

}  // namespace palpa
