#include "render/layer_lists.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstring>

namespace palpa {
namespace {

constexpr VkDeviceSize word = 4, node_bytes = 3 * word;
constexpr std::uint32_t first_room = 1 << 16;

void record_barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written,
                    VkPipelineStageFlags to, VkAccessFlags used) {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = written;
    barrier.dstAccessMask = used;
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

}  // namespace

void LayerLists::reserve(VkExtent2D size) {
    const VkDeviceSize pixels = VkDeviceSize{size.width} * size.height,
                       largest = device_->limits().maxStorageBufferRange;
    if (pixels == 0) {  // something to be named in descriptors
        if (lists_.handle() == VK_NULL_HANDLE) lists_ = create_lists(word);
        return;
    }
    heads_bytes_ = word * (1 + pixels);
    if (heads_bytes_ + node_bytes > largest) {
        throw GpuError(
            fmt::format("a picture of {}x{} pixels with translucent shapes is too large; expected "
                        "at most {} pixels in all on {}",
                        size.width, size.height, largest / word, device_->name()));
    }
    const auto most = static_cast<std::uint32_t>(
        std::min<VkDeviceSize>((largest - heads_bytes_) / node_bytes, UINT32_MAX / 4));
    const bool had_enough = room_ > 0 && (room_ >= drawn() || room_ >= most);
    if (had_enough && heads_bytes_ + node_bytes * room_ <= lists_.bytes()) return;
    // A little more than there were: the next frame is another one.
    room_ = std::min(std::max({room_, first_room, drawn() + drawn() / 4}), most);
    lists_ = create_lists(heads_bytes_ + node_bytes * room_);
    if (count_.handle() == VK_NULL_HANDLE) {
        count_ = Buffer(*device_, word, VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback);
        std::memset(count_.mapped().data(), 0, word);
    }
}

Buffer LayerLists::create_lists(VkDeviceSize bytes) const {
    return {*device_, bytes,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
            BufferPlace::Device};
}

void LayerLists::record_clear(VkCommandBuffer commands) const {
    vkCmdFillBuffer(commands, lists_.handle(), 0, heads_bytes_, 0);
    record_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                   VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

void LayerLists::record_drawn(VkCommandBuffer commands) const {
    record_barrier(commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy region{0, 0, word};
    vkCmdCopyBuffer(commands, lists_.handle(), count_.handle(), 1, &region);
    show_copies_to_host(commands);
}

bool LayerLists::had_too_little_room() const noexcept { return drawn() > room_; }

std::uint32_t LayerLists::drawn() const noexcept {
    std::uint32_t count = 0;
    if (!count_.mapped().empty()) std::memcpy(&count, count_.mapped().data(), word);
    return count;
}

}  // namespace palpa
