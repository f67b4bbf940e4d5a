// The window and its graphics, in which the start screen and scenes are shown one after the other.
#pragma once
#include "core/load_error.h"
#include "core/stage.h"
#include "core/worker.h"
#include "gpu/device.h"
#include "gpu/swapchain.h"
#include "render/renderer.h"
#include "ui/backend.h"
#include "window/window.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpa {

// Keeps what a person chose, if it can be kept; returns why not.
template <class Function, class Value>
std::string keep_choice(const Function& function, const Value& value) {
    try {
        if (function) function(value);
        return {};
    } catch (const LoadError& error) {
        return error.what();
    }
}

inline constexpr double text_step = 1.1;  // factor between two text sizes

// The scale of the window's text, relative to the display's.
struct TextScaleChoice {
    double scale = 1;                        // to begin with
    std::function<void(double)> remember{};  // what the person chose; throws LoadError
};

struct LanguageChoice {
    std::string code{};  // to begin with; empty: as the environment says
    std::function<void(const std::string&)> remember{};  // what the person chose; throws LoadError
};

// The size of the window in the display's own units.
struct WindowSizeChoice {
    std::optional<std::array<int, 2>> size{};                   // none: it fills the screen
    std::function<void(const std::array<int, 2>&)> remember{};  // throws LoadError
};

struct ThemeChoice {
    bool is_dark = false;                  // to begin with
    std::function<void(bool)> remember{};  // what the person chose; throws LoadError
};

struct ShellOptions {
    std::string title{"Palpa"};
    std::uint32_t width = 1280, height = 800;
    bool has_size = false;    // somebody asked for that size in pixels
    WindowSizeChoice size{};  // else
    TextScaleChoice text_scale{};
    LanguageChoice language{};
    ThemeChoice theme{};
    bool validation = false;                  // validates all Vulkan calls
    std::filesystem::path files_folder{"."};  // of screenshots; made when it is needed
};

// All objects that depend on the graphics device, created and destroyed together.
struct Graphics {
    Graphics(const Window& window, bool validation, double text_scale);

    std::unique_ptr<GpuDevice> owned_device;
    GpuDevice& device;
    Swapchain swapchain;
    Renderer renderer;
    UiBackend ui;
};

// A picture behind panels, which turns.
struct PictureBehind {
    FrameScene picture{};
    float free_share = 1;  // of the width
    std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
};

// Stretches the renderer's picture over an image of the window.
void stretch_over(VkCommandBuffer commands, const Renderer& renderer, VkExtent2D size,
                  VkImage image, VkExtent2D image_size);

// One instance at a time, on the main thread.
class WindowShell {
public:
    // Throws PlatformError without a display, GpuError.
    explicit WindowShell(const ShellOptions& options);
    WindowShell(const WindowShell&) = delete;
    WindowShell& operator=(const WindowShell&) = delete;
    ~WindowShell();  // the size of the window is remembered

    Window& window() noexcept { return window_; }
    // Null after the device was lost, until restart_graphics().
    Graphics* graphics() noexcept { return graphics_.get(); }
    void restart_graphics();

    double text_scale() const noexcept { return text_scale_; }
    // Sets the graphics up again with this text scale, limited by the size of the window; returns a
    // notice for the person.
    std::string change_text_scale(double scale);

    // Changes the language from the next frame on; returns a notice for the person, or nothing.
    std::string change_language(const std::string& code);

    // Changes the theme from the next frame on; returns a notice for the person, or nothing.
    std::string change_theme(bool is_dark);

    // Calls `frame` at most `most_frames_per_s` times a second until it returns false, or a signal
    // asks the program to end. A device that is lost is set up again, and `on_lost` called.
    void run(double most_frames_per_s, const std::function<bool()>& frame,
             const std::function<void()>& on_lost);

    // Reads the input for a screen of panels. F12 requests a screenshot, Ctrl+Q closes
    // the window.
    const Input& poll();
    // Draws one frame of panels, which `describe` describes to ImGui; does nothing while the window
    // is minimised. `paint` draws pictures below the panels into an image in TRANSFER_DST_OPTIMAL.
    void draw_panels(const std::function<void()>& describe,
                     const std::function<void(VkCommandBuffer, VkImage)>& paint = {});
    // Shows this picture behind all panels from now on, turning slowly, in the part of the window
    // to the left of `free_share` of its width; none: nothing.
    void show_behind(std::optional<FrameScene> picture, float free_share = 1);

    // Where a screenshot was saved, or why it could not be saved, since the last call.
    std::string take_notice() { return std::exchange(notice_, {}); }

    // Runs the task on the worker thread and shows its progress under `title`. Returns false if the
    // person cancelled it or closed the window: then its next call of the stage function ended it.
    // Throws what the task throws.
    bool work(const std::string& title, const std::function<void(const StageFunction&)>& task);

    // Longest time between two pictures during the last work(), ms.
    double longest_pause_ms() const noexcept { return longest_pause_ms_; }

    // Throws GpuError with the first message of the validation layer, if any.
    void check_validation();

private:
    void keep_validation_messages();
    void paint_behind(VkCommandBuffer commands, VkImage image);

    ShellOptions options_;
    // Created before this thread lowers its priority, so that it and the threads that it starts
    // (servos, simulations) have the normal one.
    Worker worker_;
    double text_scale_;  // relative to the display's
    Window window_;
    std::unique_ptr<Graphics> graphics_;
    bool must_rebuild_ = false;  // draw_panels() must rebuild the swapchain
    bool wants_shot_ = false;
    std::optional<PictureBehind> behind_;
    double longest_pause_ms_ = 0;
    std::string notice_;
    std::vector<std::string> validation_messages_;
};

}  // namespace palpa
