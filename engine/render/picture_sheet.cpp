#include "render/picture_sheet.h"

#include "core/assertion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace palpa {
namespace {

// What every device can have (maxImageDimension2D).
constexpr std::uint32_t largest_side = 4096;

VkImageMemoryBarrier change_layout(VkImage image, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    return barrier;
}

void upload(GpuDevice& device, const Buffer& source, VkImage image, VkExtent2D size) {
    device.submit([&](VkCommandBuffer commands) {
        VkImageMemoryBarrier ready =
            change_layout(image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        ready.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &ready);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {size.width, size.height, 1};
        vkCmdCopyBufferToImage(commands, source.handle(), image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        VkImageMemoryBarrier filled = change_layout(image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        filled.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        filled.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &filled);
    });
}

}  // namespace

PictureSheet::PictureSheet(GpuDevice& device, std::span<const Picture> pictures)
    : each_{}, count_(pictures.size()) {
    if (pictures.empty()) return;
    each_ = {pictures[0].width, pictures[0].height};
    columns_ = std::max(1U, largest_side / each_.width);
    const auto rows = (static_cast<std::uint32_t>(count_) + columns_ - 1) / columns_;
    const VkExtent2D all{each_.width * columns_, each_.height * rows};
    if (all.width > largest_side || all.height > largest_side)
        throw GpuError(
            "the pictures are too large together for a graphics device; use fewer or smaller ones");
    const std::size_t row_bytes = 4 * static_cast<std::size_t>(each_.width);
    const Buffer staging(device, row_bytes * columns_ * all.height,
                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::Readback);
    for (std::size_t i = 0; i < count_; ++i) {
        PALPA_ASSERT(pictures[i].rgba.size() == row_bytes * each_.height);
        const std::size_t first_row = i / columns_ * each_.height;
        for (std::size_t y = 0; y < each_.height; ++y) {
            const std::size_t to = ((first_row + y) * columns_ + i % columns_) * row_bytes;
            std::memcpy(staging.mapped().data() + to, pictures[i].rgba.data() + y * row_bytes,
                        row_bytes);
        }
    }
    image_ = Image(device, all, VK_FORMAT_R8G8B8A8_UNORM,
                   VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                       VK_IMAGE_USAGE_SAMPLED_BIT,  // a view needs one that a shader could use
                   VK_IMAGE_ASPECT_COLOR_BIT);
    upload(device, staging, image_.handle(), all);
}

void PictureSheet::record(VkCommandBuffer commands, std::size_t number, VkImage image,
                          const PixelBox& to, const PixelBox& within) const {
    const PixelBox shown = common(to, within);
    if (number >= count_ || to.is_empty() || shown.is_empty()) return;
    const auto column = static_cast<int>(number % columns_ * each_.width);
    const auto row = static_cast<int>(number / columns_ * each_.height);
    const auto source_x = [&](int x) {
        return column + static_cast<int>(std::lround(static_cast<double>(x - to.left) *
                                                     each_.width / to.width()));
    };
    const auto source_y = [&](int y) {
        return row + static_cast<int>(
                         std::lround(static_cast<double>(y - to.top) * each_.height / to.height()));
    };
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[0] = {source_x(shown.left), source_y(shown.top), 0};
    region.srcOffsets[1] = {source_x(shown.right), source_y(shown.bottom), 1};
    region.dstOffsets[0] = {shown.left, shown.top, 0};
    region.dstOffsets[1] = {shown.right, shown.bottom, 1};
    vkCmdBlitImage(commands, image_.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
}

}  // namespace palpa
