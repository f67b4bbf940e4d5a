#include "scene/renames.h"

#include <algorithm>
#include <array>
#include <string>

namespace palpa {
namespace {

// A key in full, as it is now, and its last part before.
struct RenamedKey {
    std::string_view now, before;
};
constexpr std::array renamed_keys = std::to_array<RenamedKey>({
    {"view.colour", "colouring"},
    {"edits.appearance.colour", "colouring"},
});

struct RenamedValue {
    std::string_view key, before, now;
};
constexpr std::array renamed_values = std::to_array<RenamedValue>({
    {"statics.weights", "plain", "acceleration"},
    {"statics.weights", "single", "per-joint"},
    {"statics.weights", "light", "inverse-moved-atoms"},
    {"statics.weights", "near-hand", "hand-proximity"},
});

// "edits[2].appearance." without the number, as the tables above have it.
std::string without_numbers(std::string_view key) {
    std::string name;
    bool is_number = false;
    for (const char c : key) {
        if (c == '[') is_number = true;
        if (!is_number) name += c;
        if (c == ']') is_number = false;
    }
    return name;
}

}  // namespace

std::string_view find_key_before(std::string_view table, std::string_view key) {
    const bool has_namesake = std::ranges::any_of(
        renamed_keys, [&](const RenamedKey& renamed) { return renamed.now.ends_with(key); });
    if (!has_namesake) return {};  // as most keys
    const std::string name = without_numbers(table) + std::string(key);
    const auto* const found = std::ranges::find(renamed_keys, name, &RenamedKey::now);
    return found == renamed_keys.end() ? std::string_view() : found->before;
}

std::string_view find_value_now(std::string_view key, std::string_view value) {
    for (const RenamedValue& renamed : renamed_values) {
        if (renamed.before == value && renamed.key == key) return renamed.now;
    }
    return {};
}

}  // namespace palpa
