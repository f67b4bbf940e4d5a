// Connects the overlay library to a window and a render pass.
#pragma once
#include "gpu/device.h"
#include "window/window.h"

#include <cstdint>

namespace palpa {

// One at a time. Between `begin` and `end` overlays are described; `draw` draws them.
class UiBackend {
public:
    // `pass` has one colour attachment; `images`: number of frames in flight. `text_scale`: size of
    // text and panels relative to normal. Throws GpuError.
    UiBackend(const Window& window, GpuDevice& device, VkRenderPass pass, std::uint32_t images,
              float text_scale);
    UiBackend(const UiBackend&) = delete;
    UiBackend& operator=(const UiBackend&) = delete;
    ~UiBackend();

    // `has_cursor`: false while the cursor is captured; then nothing is pointed at.
    void begin(bool has_cursor = true);
    void end();
    void draw(VkCommandBuffer commands);

    // True if an overlay covered this point of the last frame, in pixels.
    bool covers(double x, double y) const;

private:
    GpuDevice& device_;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
};

// Sets fonts and colours of the overlays in the present context.
void set_ui_style(float text_scale);

}  // namespace palpa
