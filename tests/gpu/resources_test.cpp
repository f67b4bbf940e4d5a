#include "gpu/resources.h"

#include "tests/support/gpu.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <span>
#include <vector>

using namespace palpa;

TEST_CASE("what is uploaded comes back the same, through shared memory and through staging",
          "[gpu]") {
    const bool force_staging = GENERATE(false, true);
    GpuDevice device(test::validated(force_staging));
    std::vector<std::byte> content(10'000);
    for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<std::byte>(i * 7);

    UploadBuffer there(device, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    REQUIRE(there.reserve(100));
    REQUIRE(there.reserve(content.size()));
    std::copy(content.begin(), content.end(), there.mapped().begin());
    const Buffer back(device, content.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                      BufferPlace::Readback);
    device.submit([&](VkCommandBuffer commands) {
        there.record(commands, content.size());
        VkMemoryBarrier barrier{};  // `record` makes it ready for shaders, this for copies
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &barrier, 0, nullptr, 0,
                             nullptr);
        const VkBufferCopy region{0, 0, content.size()};
        vkCmdCopyBuffer(commands, there.handle(), back.handle(), 1, &region);
        show_copies_to_host(commands);
    });

    CHECK(std::equal(content.begin(), content.end(), back.mapped().begin()));
    CHECK_FALSE(there.reserve(100));  // what is there is large enough
    test::check_silent(device);
}

TEST_CASE("validation is really on: a mistake is reported", "[gpu]") {
    GpuDevice device(test::validated());
    const Buffer small(device, 64, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::Readback);
    const Buffer large(device, 128, VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback);

    device.submit([&](VkCommandBuffer commands) {
        const VkBufferCopy region{32, 0, 64};  // 32 bytes past the end
        vkCmdCopyBuffer(commands, small.handle(), large.handle(), 1, &region);
    });

    CHECK_FALSE(device.validation_messages().empty());
}
