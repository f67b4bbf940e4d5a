// Gathers what is wrong with a scene, so that all problems are reported in the order of the file;
// and where its fields stand.
#pragma once
#include "core/load_error.h"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {

using FieldPlaces = std::map<std::string, TextPlace, std::less<>>;  // by full key

class Problems {
public:
    explicit Problems(const std::filesystem::path& file) : file_(file.string()) {}

    void add(const TextPlace& place, std::string what) {
        problems_.push_back({place, std::move(what)});
    }
    bool any() const { return !problems_.empty(); }

    // What is no problem, and worth a sentence: "file:line:column: what".
    void add_note(const TextPlace& place, std::string_view what);
    std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }

    // Where a field was read, or the table where it should be, or the file.
    void set_place(const std::string& key, const TextPlace& place) { places_[key] = place; }
    TextPlace place_of(std::string_view key) const;

    // Throws one LoadError with all problems, in the order of the file (join_problems in
    // core/load_error.h), or gives the places of all fields that the file has.
    FieldPlaces finish();

private:
    struct Problem {
        TextPlace place;
        std::string what;
    };

    std::string file_;
    std::vector<Problem> problems_;
    std::vector<std::string> notes_;
    FieldPlaces places_;
};

}  // namespace palpa
