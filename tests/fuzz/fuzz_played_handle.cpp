// Any text is a table that a handle can play, as a script and as a trace, or a LoadError.
#include "core/load_error.h"
#include "devices/played_handle.h"
#include "tests/fuzz/expect.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;

namespace {

void check_played(const std::vector<PlayedRow>& rows) {
    PALPA_EXPECT(!rows.empty());
    for (std::size_t i = 1; i < rows.size(); ++i) {
        PALPA_EXPECT(rows[i].time_s > rows[i - 1].time_s);
    }
    PlayedHandle handle({.rows = rows});
    for (int i = 0; i < 50; ++i) {
        const DeviceReading reading = handle.read();
        PALPA_EXPECT(reading.position_m.cwiseAbs().maxCoeff() <= trace_reach_m);
        PALPA_EXPECT(std::abs(reading.orientation.norm() - 1) < 1e-9);
        handle.write(Vec3::Zero());
    }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    for (const auto parse : {parse_script, parse_trace}) {
        std::vector<PlayedRow> rows;
        try {
            rows = parse(text, "fuzz.csv");
        } catch (const LoadError&) {
            continue;
        }
        check_played(rows);
    }
    return 0;
}
