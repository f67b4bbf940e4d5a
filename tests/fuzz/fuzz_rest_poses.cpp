// Any text is a file of poses or a LoadError; one that is reads the same once written.
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"
#include "tools/lab/experiments/rest_poses.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

using namespace palpa;

namespace {

std::optional<RestPoses> read_or_refuse(std::string_view text) {
    return test::or_refused([&] { return parse_rest_poses(text, "poses.txt"); });
}

void check_rest(const RestPose& rest, const PosedModel& of) {
    PALPA_EXPECT(rest.angles.size() == of.bodies);
    PALPA_EXPECT(rest.turns.size() == of.molecules && rest.shifts.size() == of.molecules);
    PALPA_EXPECT(rest.springs.size() == of.springs);
    PALPA_EXPECT(!rest.moves.empty());
    for (const RestMove& move : rest.moves)
        PALPA_EXPECT(move.by.allFinite() && move.change_pN.allFinite());
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::optional<RestPoses> poses =
        read_or_refuse({reinterpret_cast<const char*>(data), size});
    if (!poses) return 0;
    PALPA_EXPECT(!poses->poses.empty());
    for (const RestPosePair& pair : poses->poses) {
        check_rest(pair.all_pairs, poses->of);
        check_rest(pair.with_cutoff, poses->of);
    }
    const std::string written = format_rest_poses(*poses);
    const std::optional<RestPoses> back = read_or_refuse(written);
    PALPA_EXPECT(back);
    PALPA_EXPECT(format_rest_poses(*back) == written);
    return 0;
}
