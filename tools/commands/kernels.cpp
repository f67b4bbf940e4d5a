#include "tools/commands/kernels.h"

#include "core/load_error.h"
#include "core/text.h"
#include "field/processor.h"
#include "session/recording.h"

#include <fmt/format.h>
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

// The value of PALPA_KERNELS; empty where it is not set.
std::string_view kernels_of_environment() {
    const char* const kind = std::getenv("PALPA_KERNELS");
    return kind ? kind : std::string_view{};
}

bool has_kernels(std::string_view kind) {
    const std::vector<std::string> kinds = list_processor_kinds();
    return std::ranges::find(kinds, kind) != kinds.end();
}

// Eigen sums products of large matrices in blocks that fit the processor's caches. With caches of
// one size the sums are the same on every processor.
void fix_blocks() {
    constexpr std::ptrdiff_t kibibyte = 1024;
    Eigen::setCpuCacheSizes(32 * kibibyte, 512 * kibibyte, 4096 * kibibyte);
}

}  // namespace

void choose_kernels() {
    fix_blocks();
    const std::string_view kind = kernels_of_environment();
    if (kind.empty()) return;
    if (!has_kernels(kind)) {
        throw LoadError(
            {"PALPA_KERNELS"},
            fmt::format("'{}' is no kind of kernels here; expected {}",
                        printable(std::string(kind)), fmt::join(list_processor_kinds(), ", ")));
    }
    use_processor_kind(kind);
}

RecordedKernels::RecordedKernels(const std::filesystem::path& folder) : before_(processor_kind()) {
    if (!kernels_of_environment().empty()) return;
    const std::string recorded = read_recorded_kernels(folder);
    if (has_kernels(recorded)) {
        use_processor_kind(recorded);
    } else if (!recorded.empty()) {
        fmt::print(stderr,
                   "note: recorded with the kernels {}, which this processor does not have; played "
                   "with {}\n",
                   printable(recorded), before_);
    }
}

RecordedKernels::~RecordedKernels() { use_processor_kind(before_); }

}  // namespace palpa
