// Any bytes unpack to at most what is allowed, or are refused.
#include "formats/gzip.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

using namespace palpa;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t most = 1 << 20;
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const auto text = test::or_refused([&] { return unpack_gzip(bytes, "fuzz.gz", most); });
    if (text) PALPA_EXPECT(text->size() <= most);
    return 0;
}
