// What was decided on the way from a structure file to a system, for people to read and to doubt.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {

// Decisions under headings, both in the order in which they came.
class Report {
public:
    void add(std::string_view heading, std::string decision);

    // Things that a user should look at before trusting the system; also printed on their own.
    void warn(std::string decision);

    const std::vector<std::string>& warnings() const noexcept { return warnings_; }

    // All of it: warnings first, then each heading with its lines.
    std::string to_text() const;

private:
    std::vector<std::pair<std::string, std::vector<std::string>>> sections_;
    std::vector<std::string> warnings_;
};

}  // namespace palpa
