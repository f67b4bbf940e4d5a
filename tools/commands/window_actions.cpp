#include "tools/commands/window_actions.h"

#include "core/files.h"

#include <fmt/format.h>
#include <array>
#include <string_view>

namespace palpa {
namespace {

constexpr std::string_view columns = "time_s,action,by\n";
constexpr std::array<std::string_view, 5> ways{"key", "menu", "toolbar", "search", "panel"};

}  // namespace

void print_actions() {
    for (const Action& action : list_actions()) {
        const std::string keys = keys_of(action);
        fmt::print("{}\n  {}; menu {}{}{}\n  {}\n", action.id, action.text, name_of(action.menu),
                   keys.empty() ? "" : "; ", keys, action.explains);
    }
}

ActionFile::ActionFile(const std::filesystem::path& file, bool overwrites) {
    write_text_file(file, columns, check_output(file, columns, overwrites));
    file_.reset(std::fopen(file.string().c_str(), "a"));
}

void ActionFile::add(double time_s, const Action& action, By by) {
    if (!file_) return;
    fmt::print(file_.get(), "{:.3f},{},{}\n", time_s, action.id,
               ways.at(static_cast<std::size_t>(by)));
    (void)std::fflush(file_.get());
}

}  // namespace palpa
