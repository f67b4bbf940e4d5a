// Any text is a coordinate file or a LoadError; what was read survives being written and read.
#include "formats/crd.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

using namespace palpa;

namespace {

std::optional<Structure> read_or_refuse(std::string_view text) {
    return test::or_refused([&] { return parse_crd(text, "fuzz.crd"); });
}

bool is_plain(const std::string& name) {
    return std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

// Letters are not of one byte each elsewhere, and larger numbers do not fit the columns.
bool can_be_written(const Structure& structure) {
    for (const AtomName& name : structure.names) {
        if (!is_plain(name.segment + name.residue + name.number + name.atom)) return false;
    }
    return std::all_of(structure.positions.begin(), structure.positions.end(),
                       [](const Vec3& p) { return p.cwiseAbs().maxCoeff() < 1e7; });
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::optional<Structure> structure = read_or_refuse(text);
    if (!structure) return 0;

    const std::size_t count = structure->names.size();
    PALPA_EXPECT(count > 0);
    PALPA_EXPECT(structure->positions.size() == count && structure->lines.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        const AtomName& name = structure->names[i];
        PALPA_EXPECT(!name.segment.empty() && !name.residue.empty());
        PALPA_EXPECT(!name.number.empty() && !name.atom.empty());
        PALPA_EXPECT(structure->positions[i].allFinite());
        PALPA_EXPECT(structure->lines[i] > (i == 0 ? 0 : structure->lines[i - 1]));
    }

    if (!can_be_written(*structure)) return 0;
    const std::optional<Structure> back = read_or_refuse(format_crd(*structure, "fuzz"));
    PALPA_EXPECT(back && back->names.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        PALPA_EXPECT(to_string(back->names[i]) == to_string(structure->names[i]));
        // Half of the tenth decimal, and what a double of 1e7 rounds.
        const Vec3 move = back->positions[i] - structure->positions[i];
        PALPA_EXPECT(move.cwiseAbs().maxCoeff() < 2e-9);
    }
    return 0;
}
