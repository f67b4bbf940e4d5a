// Any text is an expression or a LoadError; what it selects, its negation leaves out, and no order
// of two changes what both select.
#include "molecule/select.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"
#include "tests/molecule/select_system.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;

namespace {

using Chosen = std::optional<std::vector<bool>>;

// Nothing where it is refused.
Chosen select(const std::string& text) {
    static const AtomTable atoms = test::one_of_each();
    static const std::vector<NamedRange> molecules{{"a", {0, 20}}, {"b c", {20, 24}}};
    static const std::vector<std::uint32_t> hand{3, 40};
    static const std::vector<SecondaryStructure> structure(atoms.size(),
                                                           SecondaryStructure::AlphaHelix);
    return test::or_refused([&] {
        return select_atoms(parse_selection(text), {atoms, molecules, hand, structure, {}});
    });
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const Chosen chosen = select(text);
    if (!chosen) return 0;
    PALPA_EXPECT(chosen->size() == 44);

    // An expression that is as deep as may be cannot be put into another one.
    const Chosen left = select("not (" + text + ")");
    if (!left) return 0;
    for (std::size_t i = 0; i < chosen->size(); ++i) PALPA_EXPECT((*chosen)[i] != (*left)[i]);
    const Chosen both = select("(" + text + ") and protein");
    const Chosen swapped = select("protein and (" + text + ")");
    PALPA_EXPECT(both && both == swapped);
    return 0;
}
