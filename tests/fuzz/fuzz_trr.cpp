// Any bytes are a TRR trajectory or a LoadError.
#include "formats/trr.h"
#include "tests/fuzz/expect_trajectory.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

using namespace palpa;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const std::unique_ptr<Trajectory> trajectory =
        test::open_or_refuse([&] { return open_trr(ByteSource(bytes, "fuzz.trr")); });
    if (trajectory) test::expect_whole(*trajectory);
    return 0;
}
