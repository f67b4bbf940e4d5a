// The code that any text names is a plain one, which names itself.
#include "download/pdb_code.h"
#include "tests/fuzz/expect.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

using namespace palpa;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto code = find_pdb_code({reinterpret_cast<const char*>(data), size});
    if (!code) return 0;
    PALPA_EXPECT(is_pdb_code(*code));
    PALPA_EXPECT(plain_pdb_code(*code) == *code);
    PALPA_EXPECT(find_pdb_code(*code) == code);
    return 0;
}
