#include "tools/commands/scene_keys.h"

#include "core/hands.h"
#include "core/load_error.h"
#include "core/text.h"
#include "scene/fields.h"

#include <fmt/format.h>
#include <cstddef>
#include <string_view>

namespace palpa {
namespace {

// "coupling.mode" is found by its name, its last part, and its table, also as "coupling.".
bool is_asked_for(std::string_view key, std::string_view asked) {
    if (asked == "keys" || key == asked || key.ends_with("." + std::string(asked))) return true;
    if (asked.ends_with('.')) asked.remove_suffix(1);
    return key.starts_with(std::string(asked) + ".") || key.starts_with(std::string(asked) + "[");
}

// The key under which a key of one hand is listed: "grab.atom" for "hand[2].grab.atom".
std::string listed_key(std::string asked) {
    for (std::size_t number = 1; number <= most_hands; ++number) {
        const std::string own_key = fmt::format("hand[{}]", number);
        if (asked.starts_with(own_key)) asked.replace(0, own_key.size(), "hand");
    }
    constexpr std::string_view old_second = "second.";
    if (asked.starts_with("second.hand"))
        asked.erase(0, old_second.size());
    else if (asked.starts_with(old_second))
        asked.replace(0, old_second.size(), "hand.");
    constexpr std::string_view own = "hand.";
    for (const std::string_view part : {"grab", "device", "coupling"}) {
        if (!asked.starts_with(own)) return asked;
        std::string rest = asked.substr(own.size());
        if (rest == part || rest.starts_with(std::string(part) + ".")) return rest;
    }
    return asked;
}

std::vector<FieldNote> find_fields(const std::string& asked) {
    std::vector<FieldNote> found = list_fields();
    const std::string key = listed_key(asked);
    std::erase_if(found, [&](const FieldNote& field) { return !is_asked_for(field.key, key); });
    return found;
}

// The nearest of the keys and of their last parts.
std::string near_key_hint(const std::string& asked) {
    const std::vector<FieldNote> fields = list_fields();
    std::vector<std::string_view> known;
    for (const FieldNote& field : fields) {
        known.push_back(field.key);
        known.push_back(
            std::string_view(field.key).substr(std::string_view(field.key).rfind('.') + 1));
    }
    return near_name_hint(asked, known);
}

}  // namespace

bool print_scene_keys(const std::vector<std::string>& asked) {
    for (const std::string& key : asked) {
        if (!find_fields(key).empty()) continue;
        const std::string hint = near_key_hint(key);
        if (hint.empty() && key == asked.front()) return false;
        throw LoadError({"palpa help"}, fmt::format("unknown key '{}'{}; 'palpa help keys' has all",
                                                    printable(key), hint));
    }
    for (const std::string& key : asked) {
        for (const FieldNote& field : find_fields(key)) {
            fmt::print("{}\n  {}\n  value: {}; unless given: {}\n", field.key, field.meaning,
                       field.type, field.fallback);
        }
    }
    return true;
}

}  // namespace palpa
