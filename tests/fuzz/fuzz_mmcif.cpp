// Any text is a structure or a LoadError.
#include "core/load_error.h"
#include "formats/mmcif.h"
#include "tests/fuzz/expect_structure.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

using namespace palpa;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        test::expect_whole(parse_mmcif(text, "fuzz.cif"));
    } catch (const LoadError&) {
        return 0;
    }
    return 0;
}
