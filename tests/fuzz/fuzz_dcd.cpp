// Any bytes are a DCD trajectory or a LoadError.
#include "formats/dcd.h"
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
        test::open_or_refuse([&] { return open_dcd(ByteSource(bytes, "fuzz.dcd")); });
    if (trajectory) test::expect_whole(*trajectory);
    return 0;
}
