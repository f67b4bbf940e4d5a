// Any text is a GRO file, or an index file, or a LoadError.
#include "formats/gro.h"
#include "formats/index_file.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

using namespace palpa;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto groups = test::or_refused([&] { return parse_index_file(text, "fuzz.ndx"); });
    if (groups) PALPA_EXPECT(!groups->empty());

    const auto structure = test::or_refused([&] { return parse_gro(text, "fuzz.gro"); });
    if (!structure) return 0;
    const std::size_t count = structure->names.size();
    PALPA_EXPECT(count > 0 && structure->positions.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        PALPA_EXPECT(!structure->names[i].segment.empty() && !structure->names[i].atom.empty());
        PALPA_EXPECT(structure->positions[i].allFinite());
    }
    return 0;
}
