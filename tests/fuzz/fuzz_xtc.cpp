// Any bytes are an XTC trajectory or a LoadError, and any whole-number places survive packing.
#include "formats/xtc.h"
#include "formats/xtc_packing.h"
#include "tests/fuzz/expect_trajectory.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

using namespace palpa;

namespace {

void expect_packed_alike(const std::vector<IntegerPlace>& places) {
    const std::optional<PackedPlaces> packed = pack_places(places);
    if (!packed) return;
    std::vector<IntegerPlace> back(places.size());
    PALPA_EXPECT(
        unpack_places(packed->least, packed->greatest, packed->small, packed->bits, back).empty());
    PALPA_EXPECT(back == places);
    PALPA_EXPECT(places.size() <= most_packed_places(packed->bits.size()));
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const std::unique_ptr<Trajectory> trajectory =
        test::open_or_refuse([&] { return open_xtc(ByteSource(bytes, "fuzz.xtc")); });
    if (trajectory) test::expect_whole(*trajectory);

    // The same bytes as places, far apart, and as steps of a walk, near each other.
    std::vector<IntegerPlace> far(size / sizeof(IntegerPlace)), walk(size / 3);
    if (!far.empty()) {
        std::memcpy(far.data(), data, far.size() * sizeof(IntegerPlace));
        expect_packed_alike(far);
    }
    IntegerPlace at{};
    for (std::size_t i = 0; i < walk.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // Even bytes are steps, odd ones steps of up to 2^12 times as much.
            const auto byte = static_cast<std::int8_t>(data[3 * i + axis]);
            at[axis] += byte % 2 == 0 ? byte : byte * (1 << (byte & 12));
        }
        walk[i] = at;
    }
    if (!walk.empty()) expect_packed_alike(walk);
    return 0;
}
