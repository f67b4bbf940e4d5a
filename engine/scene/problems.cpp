#include "scene/problems.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

namespace palpa {

TextPlace Problems::place_of(std::string_view key) const {
    const auto found = places_.find(key);
    if (found != places_.end()) return found->second;
    const std::size_t dot = key.rfind('.');
    if (dot == std::string_view::npos) return {file_, 1, 1};
    return place_of(key.substr(0, dot));
}

void Problems::add_note(const TextPlace& place, std::string_view what) {
    notes_.push_back(fmt::format("{}: {}", to_string(place), what));
}

FieldPlaces Problems::finish() {
    if (problems_.empty()) return std::move(places_);
    std::stable_sort(problems_.begin(), problems_.end(), [](const Problem& a, const Problem& b) {
        return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
    });
    std::vector<std::string> texts;
    for (const Problem& problem : problems_) {
        texts.push_back(texts.empty()
                            ? problem.what
                            : fmt::format("{}: {}", to_string(problem.place), problem.what));
    }
    throw join_problems(problems_[0].place, texts);
}

}  // namespace palpa
