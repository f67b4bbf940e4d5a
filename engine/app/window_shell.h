// The window on the display, and what draws into it. The start screen and one scene after the other
// are shown in the same one.
#pragma once
#include "app/worker.h"
#include "core/stage.h"
#include "gpu/device.h"
#include "gpu/swapchain.h"
#include "render/renderer.h"
#include "ui/backend.h"
#include "window/window.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

inline constexpr double text_step = 1.1;  // of larger and smaller text

inline constexpr glm::vec3 window_background{0.86F, 0.89F, 0.93F};  // linear light

// The size of the window's text, over what the display asks for.
struct TextScaleChoice {
    double scale = 1;                        // to begin with
    std::function<void(double)> remember{};  // what the person chose; throws LoadError
};

struct LanguageChoice {
    std::string code{};  // to begin with; empty: as the environment says
    std::function<void(const std::string&)> remember{};  // what the person chose; throws LoadError
};

struct ShellOptions {
    std::string title{"Palpa"};
    std::uint32_t width = 1280, height = 800;
    bool grows = true;  // with the display's scale: nobody asked for that size in pixels
    TextScaleChoice text_scale{};
    LanguageChoice language{};
    bool validation = false;                 // of all calls of Vulkan
    std::filesystem::path screenshots{"."};  // folder
};

// All that is lost with a device, made and thrown away as one.
struct Graphics {
    Graphics(const Window& window, bool validation, double text_scale);

    GpuDevice device;
    Swapchain swapchain;
    Renderer renderer;
    UiBackend ui;
};

// One at a time, on the main thread.
class WindowShell {
public:
    // Throws PlatformError without a display, GpuError.
    explicit WindowShell(const ShellOptions& options);

    Window& window() noexcept { return window_; }
    // Null after a device was lost, until restart_graphics().
    Graphics* graphics() noexcept { return graphics_.get(); }
    void restart_graphics();

    double text_scale() const noexcept { return text_scale_; }
    // Sets the graphics up again with text so large, as far as the window has room for it; returns
    // a notice for the person.
    std::string change_text_scale(double scale);

    // Of all text from the next frame on; returns a notice for the person, if any.
    std::string change_language(const std::string& code);

    // Calls `frame` at most `most_frames_per_s` times a second until it returns false, or a signal
    // asks the program to end. A device that is lost is set up again, and `on_lost` called.
    void run(double most_frames_per_s, const std::function<bool()>& frame,
             const std::function<void()>& on_lost);

    // What came in, for a screen of panels. F12 asks for a screenshot of it.
    const Input& poll();
    // One frame of panels alone, described to the overlay library; nothing while the window is
    // folded away. `paint` puts pictures below the panels, into an image in TRANSFER_DST_OPTIMAL.
    void draw_panels(const std::function<void()>& describe,
                     const std::function<void(VkCommandBuffer, VkImage)>& paint = {});
    // Where a screenshot went, or why it could not be saved, since the last call.
    std::string take_notice() { return std::exchange(notice_, {}); }

    // Does the task on a thread of its own, and shows under `title` how far it is. False where the
    // person cancelled it, or closed the window: its next call of the stage function ended it.
    // Throws what the task does.
    bool work(const std::string& title, const std::function<void(const StageFunction&)>& task);

    // Of the last work: the longest time from one picture to the next.
    double longest_pause_ms() const noexcept { return longest_pause_ms_; }

    // Throws GpuError with the first that validation found so far.
    void check_validation();

private:
    void keep_validation_messages();

    ShellOptions options_;
    Worker worker_;      // before the priority of this thread is lowered
    double text_scale_;  // over the display's own
    Window window_;
    std::unique_ptr<Graphics> graphics_;
    bool must_rebuild_ = false;  // the swapchain, for draw_panels()
    bool wants_shot_ = false;
    double longest_pause_ms_ = 0;
    std::string notice_;
    std::vector<std::string> validation_messages_;
};

}  // namespace palpa
