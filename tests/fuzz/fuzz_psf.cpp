// Any text is a structure file or a LoadError; what was read is whole, and survives being written
// and read.
#include "core/load_error.h"
#include "formats/psf.h"
#include "tests/fuzz/expect.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

using namespace palpa;

namespace {

std::optional<Topology> read_or_refuse(std::string_view text) {
    try {
        return parse_psf(text, "fuzz.psf");
    } catch (const LoadError&) {
        return std::nullopt;
    }
}

template <class Tuples>
void expect_indices(const Tuples& tuples, std::size_t count) {
    for (const auto& tuple : tuples) {
        for (const std::uint32_t atom : tuple) PALPA_EXPECT(atom < count);
    }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::optional<Topology> topology = read_or_refuse(text);
    if (!topology) return 0;

    const std::size_t count = topology->names.size();
    PALPA_EXPECT(count > 0 && count <= size);
    PALPA_EXPECT(topology->type.size() == count && topology->lines.size() == count);
    PALPA_EXPECT(topology->charge.size() == count && topology->mass.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        PALPA_EXPECT(std::isfinite(topology->charge[i]) && topology->mass[i] >= 0);
    }
    expect_indices(topology->bonds, count);
    expect_indices(topology->angles, count);
    expect_indices(topology->dihedrals, count);
    expect_indices(topology->impropers, count);
    expect_indices(topology->cmaps, count);

    const std::optional<Topology> back = read_or_refuse(format_psf(*topology, "fuzz"));
    PALPA_EXPECT(back && back->names.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        PALPA_EXPECT(to_string(back->names[i]) == to_string(topology->names[i]));
        PALPA_EXPECT(back->type[i] == topology->type[i]);
    }
    PALPA_EXPECT(back->bonds == topology->bonds && back->angles == topology->angles);
    PALPA_EXPECT(back->dihedrals == topology->dihedrals && back->cmaps == topology->cmaps);
    return 0;
}
