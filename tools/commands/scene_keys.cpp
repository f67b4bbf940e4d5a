#include "tools/commands/scene_keys.h"

#include "core/load_error.h"
#include "core/text.h"
#include "scene/fields.h"

#include <fmt/format.h>
#include <cstddef>
#include <string_view>

namespace palpa {
namespace {

// "coupling.mode" is found by its name, its last part, and its table.
bool is_asked_for(std::string_view key, std::string_view asked) {
    if (asked == "keys" || key == asked || key.ends_with("." + std::string(asked))) return true;
    return key.starts_with(std::string(asked) + ".");
}

std::size_t explain_key(const std::string& asked) {
    std::size_t found = 0;
    for (const FieldNote& field : list_fields()) {
        if (!is_asked_for(field.key, asked)) continue;
        fmt::print("{}\n  {}\n  value: {}; unless given: {}\n", field.key, field.meaning,
                   field.type, field.fallback);
        ++found;
    }
    return found;
}

}  // namespace

bool print_scene_keys(const std::vector<std::string>& asked) {
    for (const std::string& key : asked) {
        if (explain_key(key) > 0) continue;
        if (key.find('.') == std::string::npos) return false;
        const std::vector<FieldNote> fields = list_fields();
        std::vector<std::string_view> known;
        for (const FieldNote& field : fields) known.push_back(field.key);
        throw LoadError({"palpa help"}, fmt::format("unknown key '{}'{}; 'palpa help keys' has all",
                                                    printable(key), near_name_hint(key, known)));
    }
    return true;
}

}  // namespace palpa
