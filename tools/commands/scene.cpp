// palpa scene: what the keys of scene files mean.
#include "core/load_error.h"
#include "core/text.h"
#include "scene/fields.h"
#include "tools/commands/command.h"

#include <fmt/format.h>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

struct SceneOptions {
    std::vector<std::string> keys;
};

// "coupling.mode" is found by its name, its last part, and its table.
bool is_asked_for(std::string_view key, std::string_view asked) {
    if (key == asked || key.ends_with("." + std::string(asked))) return true;
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

int explain_keys(const SceneOptions& options) {
    for (const std::string& key : options.keys) {
        if (explain_key(key) > 0) continue;
        const std::vector<FieldNote> fields = list_fields();
        std::vector<std::string_view> known;
        for (const FieldNote& field : fields) known.push_back(field.key);
        throw LoadError({"palpa scene"},
                        fmt::format("unknown key or table '{}'{}; 'palpa run --keys' lists all",
                                    printable(key), near_name_hint(key, known)));
    }
    return 0;
}

}  // namespace

void add_scene(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& scene = *program.add_subcommand("scene", "Explain a key of scene files");
    describe(scene, "Make scenes",
             {"palpa scene coupling.mode", "palpa scene view", "palpa scene --help period_ms"});
    SceneOptions& options = own_options<SceneOptions>(scene, chosen, explain_keys);
    scene
        .add_option("key", options.keys,
                    "full key, its last part, or a table ('palpa run --keys' lists all)")
        ->required();
}

}  // namespace palpa
