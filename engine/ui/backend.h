// Brings the overlay library onto a window and into a render pass.
#pragma once
#include "gpu/device.h"
#include "platform/window.h"

#include <cstdint>

namespace palpa {

// One at a time. Between `begin` and `end` overlays are described; `draw` draws them.
class UiBackend {
public:
    // `pass` has one colour attachment; `images` of them may be under way. Throws GpuError.
    UiBackend(const Window& window, GpuDevice& device, VkRenderPass pass, std::uint32_t images);
    UiBackend(const UiBackend&) = delete;
    UiBackend& operator=(const UiBackend&) = delete;
    ~UiBackend();

    void begin();
    void end();
    void draw(VkCommandBuffer commands);

    // Whether an overlay wants the mouse or the keys for itself.
    bool wants_mouse() const;
    bool wants_keys() const;

private:
    GpuDevice& device_;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
};

// Fonts and colours of the overlays, into the present context. `text_pixels`: height of a line.
void set_ui_style(float text_pixels);

}  // namespace palpa
