// Brings the overlay library onto a window and into a render pass.
#pragma once
#include "gpu/device.h"
#include "window/window.h"

#include <cstdint>

namespace palpa {

// One at a time. Between `begin` and `end` overlays are described; `draw` draws them.
class UiBackend {
public:
    // `pass` has one colour attachment; `images` of them may be under way. `text_scale`: of text
    // and panels, over their usual size. Throws GpuError.
    UiBackend(const Window& window, GpuDevice& device, VkRenderPass pass, std::uint32_t images,
              float text_scale);
    UiBackend(const UiBackend&) = delete;
    UiBackend& operator=(const UiBackend&) = delete;
    ~UiBackend();

    void begin();
    void end();
    void draw(VkCommandBuffer commands);

    // Whether an overlay wants the mouse or the keys for itself.
    bool wants_mouse() const;
    bool wants_keys() const;
    // Whether an overlay lies at this place of the last frame, in pixels.
    bool covers(double x, double y) const;

private:
    GpuDevice& device_;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
};

// Fonts and colours of the overlays, into the present context.
void set_ui_style(float text_scale);

}  // namespace palpa
