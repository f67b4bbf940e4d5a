// Any text is a structure file or a LoadError; what was read is whole, and survives being written
// and read.
#include "formats/psf.h"
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

std::optional<Connectivity> read_or_refuse(std::string_view text) {
    return test::or_refused([&] { return parse_psf(text, "fuzz.psf"); });
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
    const std::optional<Connectivity> connectivity = read_or_refuse(text);
    if (!connectivity) return 0;

    const std::size_t count = connectivity->names.size();
    PALPA_EXPECT(count > 0 && count <= size);
    PALPA_EXPECT(connectivity->type.size() == count && connectivity->lines.size() == count);
    PALPA_EXPECT(connectivity->charge.size() == count && connectivity->mass.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        PALPA_EXPECT(std::isfinite(connectivity->charge[i]) && connectivity->mass[i] >= 0);
    }
    expect_indices(connectivity->bonds, count);
    expect_indices(connectivity->angles, count);
    expect_indices(connectivity->dihedrals, count);
    expect_indices(connectivity->impropers, count);
    expect_indices(connectivity->cmaps, count);

    const std::optional<Connectivity> back = read_or_refuse(format_psf(*connectivity, "fuzz"));
    PALPA_EXPECT(back && back->names.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        PALPA_EXPECT(to_string(back->names[i]) == to_string(connectivity->names[i]));
        PALPA_EXPECT(back->type[i] == connectivity->type[i]);
    }
    PALPA_EXPECT(back->bonds == connectivity->bonds && back->angles == connectivity->angles);
    PALPA_EXPECT(back->dihedrals == connectivity->dihedrals && back->cmaps == connectivity->cmaps);
    return 0;
}
