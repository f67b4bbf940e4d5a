// How far long work has got, for whoever waits for it.
#pragma once
#include <functional>
#include <optional>
#include <string_view>

namespace palpa {

// What is being done, and how much of it is done, 0 to 1; nothing where the end is not known. May
// be empty: then nobody waits. Called often; it must be cheap. It
// may throw, which ends the work.
using StageFunction = std::function<void(std::string_view stage, std::optional<double> share)>;

// Calls it if there is one.
inline void tell(const StageFunction& on_stage, std::string_view stage,
                 std::optional<double> share = {}) {
    if (on_stage) on_stage(stage, share);
}

}  // namespace palpa
