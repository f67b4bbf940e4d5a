// Any bytes are a packed force field or a LoadError, and so are any as the content of one; what was
// read is consistent, and packing it again keeps all of it.
#include "charmm/packed_force_field.h"
#include "tests/fuzz/expect_force_field.h"
#include "tests/fuzz/or_refused.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

using namespace palpa;

namespace {

template <class Read>
void expect_read(const Read& read) {
    const auto force_field = test::or_refused(read);
    if (!force_field) return;
    test::expect_force_field(*force_field, {"fuzz.ff", 0, 0});
    test::expect_packed(*force_field);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    expect_read([&] { return unpack_force_field(bytes, "fuzz.ff"); });
    expect_read([&] { return unpack_fields(bytes, "fuzz.ff"); });
    return 0;
}
