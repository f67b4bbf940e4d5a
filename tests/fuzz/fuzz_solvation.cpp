// Any text is a table of solvation parameters or a LoadError with a line of it; what was read is
// finite and in range.
#include "charmm/solvation_reader.h"
#include "core/load_error.h"
#include "core/text.h"
#include "tests/fuzz/expect.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

using namespace palpa;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::size_t lines = split_lines(text).size();
    SolvationTable table;
    try {
        table = parse_solvation_table(text, "fuzz.csv");
    } catch (const LoadError&) {
        return 0;
    }
    PALPA_EXPECT(!table.types.empty());
    for (const auto& [type, row] : table.types) {
        PALPA_EXPECT(!type.empty() && upper_case(type) == type);
        PALPA_EXPECT(std::isfinite(row.volume) && row.volume >= 0);
        PALPA_EXPECT(std::isfinite(row.dg_ref) && std::isfinite(row.dg_free));
        PALPA_EXPECT(std::isfinite(row.lambda) && row.lambda > 0);
        PALPA_EXPECT(row.place.file == "fuzz.csv" && row.place.line >= 2 &&
                     row.place.line <= lines);
        PALPA_EXPECT(row.is_assigned == row.source.starts_with("ASSIGNED"));
    }
    return 0;
}
