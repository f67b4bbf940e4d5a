#include "tools/commands/choice.h"

#include "core/load_error.h"
#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {

std::size_t choice_called(const std::string& option, const std::string& name,
                          std::span<const std::string_view> names) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        throw LoadError({fmt::format("{} {}", option, name)},
                        fmt::format("expected one of {}{}", fmt::join(names, ", "),
                                    near_name_hint(name, names)));
    }
    return static_cast<std::size_t>(found - names.begin());
}

}  // namespace palpa
