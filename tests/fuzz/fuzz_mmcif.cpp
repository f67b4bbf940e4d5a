// Any text is a structure or a LoadError, and so it is as a trajectory; what was read survives
// being written and read.
#include "formats/mmcif.h"
#include "formats/mmcif_models.h"
#include "tests/fuzz/expect_structure.h"
#include "tests/fuzz/expect_trajectory.h"
#include "tests/fuzz/or_refused.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

using namespace palpa;

namespace {

std::optional<Structure> read_or_refuse(std::string_view text) {
    return test::or_refused([&] { return parse_mmcif(text, "fuzz.cif"); });
}

// Names may have letters, or blanks, that are not written.
std::optional<std::string> write_or_refuse(const Structure& structure) {
    return test::or_refused([&] { return format_mmcif(structure, "fuzz"); });
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto models = test::open_or_refuse(
        [&] { return open_mmcif_models(ByteSource(std::string(text), "fuzz.cif")); });
    if (models) test::expect_whole(*models);
    const std::optional<Structure> structure = read_or_refuse(text);
    if (!structure) return 0;

    test::expect_whole(*structure);
    const std::optional<std::string> written = write_or_refuse(*structure);
    if (!written) return 0;
    const std::optional<Structure> back = read_or_refuse(*written);
    PALPA_EXPECT(back);
    PALPA_EXPECT(back->names.size() == structure->names.size());
    for (std::size_t i = 0; i < back->names.size(); ++i) {
        const AtomRecord &was = structure->records[i], &is = back->records[i];
        PALPA_EXPECT(to_string(back->names[i]) == to_string(structure->names[i]));
        PALPA_EXPECT(is.chain == was.chain && is.model == was.model);
        PALPA_EXPECT(is.alternate == was.alternate && is.element == was.element);
        PALPA_EXPECT(is.hetero == was.hetero && is.formal_charge == was.formal_charge);
        // Half of the fifth decimal.
        const Vec3 move = back->positions[i] - structure->positions[i];
        PALPA_EXPECT(move.cwiseAbs().maxCoeff() < 0.5001e-5);
    }
    return 0;
}
