// Device memory for the lists of translucent layers (shaders/layers.glsl).
#pragma once
#include "gpu/device.h"
#include "gpu/resources.h"

#include <cstdint>

namespace palpa {

// How many layers a picture has is known once it is drawn: where they were more than there was room
// for, some are missing, and the next `reserve` makes the room.
class LayerLists {
public:
    explicit LayerLists(const GpuDevice& device) : device_(&device) {}

    // For a picture of that size, or of none: no layers. The buffer may be another one afterwards.
    // Throws GpuError where the device cannot have one that large.
    void reserve(VkExtent2D size);

    // Number of layers that fit.
    std::uint32_t room() const noexcept { return room_; }

    // Before the layers are drawn; once they are drawn, outside of a pass.
    void record_clear(VkCommandBuffer commands) const;
    void record_drawn(VkCommandBuffer commands) const;

    // Whether the last recorded picture, whose commands are done, needed more layers.
    bool had_too_little_room() const noexcept;

    VkBuffer handle() const noexcept { return lists_.handle(); }

private:
    Buffer create_lists(VkDeviceSize bytes) const;
    std::uint32_t drawn() const noexcept;

    const GpuDevice* device_;
    VkDeviceSize heads_bytes_ = 0;
    std::uint32_t room_ = 0;
    Buffer lists_, count_;  // count_: how many layers were drawn, for the processor
};

}  // namespace palpa
