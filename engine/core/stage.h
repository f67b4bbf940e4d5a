// Reports the progress of long work.
#pragma once
#include <functional>
#include <optional>
#include <string_view>

namespace palpa {

// Called with the name of the present stage and its progress from 0 to 1 (unset if unknown). May be
// empty. It is called often, so it must be cheap. It may throw to cancel the work.
using StageFunction = std::function<void(std::string_view stage, std::optional<double> share)>;

// Calls `on_stage` if it is set.
inline void tell(const StageFunction& on_stage, std::string_view stage,
                 std::optional<double> share = {}) {
    if (on_stage) on_stage(stage, share);
}

}  // namespace palpa
