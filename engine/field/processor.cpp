#include "field/processor.h"

#include "core/assertion.h"

#include <hwy/highway.h>

#include <cstdint>

namespace palpa {
namespace {

// Asks once: Highway then forgets which target was chosen.
const std::vector<std::int64_t>& list_targets() {
    static const std::vector<std::int64_t> targets = [] {
        hwy::SetSupportedTargetsForTest(0);
        return hwy::SupportedAndGeneratedTargets();
    }();
    return targets;
}

std::string& chosen_kind() {
    static std::string kind;
    return kind;
}

}  // namespace

std::vector<std::string> list_processor_kinds() {
    std::vector<std::string> kinds;
    for (const std::int64_t target : list_targets()) kinds.emplace_back(hwy::TargetName(target));
    return kinds;
}

std::string processor_kind() {
    return chosen_kind().empty() ? list_processor_kinds().front() : chosen_kind();
}

void use_processor_kind(std::string_view kind) {
    for (const std::int64_t target : list_targets()) {
        if (hwy::TargetName(target) != kind) continue;
        hwy::GetChosenTarget().Update(target);
        chosen_kind() = kind;
        return;
    }
    PALPA_ASSERT(false);
}

}  // namespace palpa
