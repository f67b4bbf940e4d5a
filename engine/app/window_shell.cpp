#include "app/window_shell.h"

#include "app/screenshots.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "platform/thread.h"
#include "render/picture.h"
#include "ui/colours.h"
#include "ui/layout.h"
#include "view/orbit_camera.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <mutex>
#include <numbers>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

namespace palpa {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr double panel_frames_per_s = 60;

// Ends a task at its next stage.
struct Cancelled {};

// Draws a part that goes to and fro in the bar drawn last: work of unknown length goes on.
void draw_moving_part(double seconds) {
    constexpr float part = 0.2F, way_s = 1.5F;
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    const float width = to.x - from.x;
    const float phase = std::fmod(static_cast<float>(seconds) / way_s, 2.0F);
    const float left = from.x + (1 - std::abs(1 - phase)) * (1 - part) * width;
    ImGui::GetWindowDrawList()->AddRectFilled({left, from.y}, {left + part * width, to.y},
                                              ImGui::GetColorU32(ImGuiCol_PlotHistogram),
                                              ImGui::GetStyle().FrameRounding);
}

// How far a task is, between its thread and the window's.
class TaskProgress {
public:
    StageFunction stages() {
        return [this](std::string_view stage, std::optional<double> share) {
            if (is_cancelled) throw Cancelled{};
            const std::lock_guard lock(mutex_);
            stage_ = stage;
            share_ = share;
        };
    }

    // `is_below`: at the lower edge, below a picture.
    void draw(const std::string& title, double seconds, bool is_below) {
        const ImVec2 screen = ImGui::GetIO().DisplaySize;
        const float y = is_below ? 0.88F : 0.5F;
        ImGui::SetNextWindowPos({screen.x / 2, y * screen.y}, ImGuiCond_Always, {0.5F, 0.5F});
        ImGui::SetNextWindowSize({std::min(scaled(480), screen.x - 2 * panel_edge()), 0});
        ImGui::Begin("##task", nullptr, fixed_panel | ImGuiWindowFlags_NoTitleBar);
        ImGui::TextWrapped("%s", title.c_str());
        {
            const std::lock_guard lock(mutex_);
            const std::string share = share_ ? fmt::format(" ({:.0f} %)", 100 * *share_) : "";
            ImGui::TextDisabled(
                "%s",
                fmt::format("{}{}, {:.0f} s", translated(stage_.c_str()), share, seconds).c_str());
            ImGui::ProgressBar(static_cast<float>(share_.value_or(0)), {-1, scaled(8)}, "");
            if (!share_) draw_moving_part(seconds);
        }
        if (is_cancelled) {
            ImGui::TextDisabled("%s", translated("cancelling"));
        } else if (ImGui::Button(labelled("Cancel (Esc)").c_str())) {
            is_cancelled = true;
        }
        ImGui::End();
    }

    std::atomic<bool> is_cancelled{false};

private:
    std::mutex mutex_;
    std::string stage_{for_translation("beginning")};
    std::optional<double> share_;
};

void clear(VkCommandBuffer commands, VkImage image) {
    const auto code = [](float light) { return static_cast<float>(srgb_code(light)) / 255; };
    const VkClearColorValue colour{{code(colours().background.r), code(colours().background.g),
                                    code(colours().background.b), 1}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &colour, 1, &all);
}

}  // namespace

namespace {

// Opens the device on a thread of low priority, which the driver's threads inherit: those of a
// software driver draw behind servo, steps and renewals of the model.
std::unique_ptr<GpuDevice> open_device(const Window& window, bool validation) {
    const GpuOptions options{.validation = validation,
                             .instance_extensions = window.vulkan_extensions(),
                             .create_surface = [&window](VkInstance instance) {
                                 return window.create_surface(instance);
                             }};
    return std::async(std::launch::async,
                      [&options] {
                          lower_priority();
                          return std::make_unique<GpuDevice>(options);
                      })
        .get();
}

}  // namespace

Graphics::Graphics(const Window& window, bool validation, double text_scale)
    : owned_device(open_device(window, validation)),
      device(*owned_device),
      swapchain(device, window.size()),
      renderer(device),
      ui(window, device, swapchain.overlay_pass(), swapchain.image_count(),
         static_cast<float>(text_scale) * window.content_scale()) {}

void stretch_over(VkCommandBuffer commands, const Renderer& renderer, VkExtent2D size,
                  VkImage image, VkExtent2D image_size) {
    const auto corner = [](VkExtent2D extent) {
        return VkOffset3D{static_cast<std::int32_t>(extent.width),
                          static_cast<std::int32_t>(extent.height), 1};
    };
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = corner(size);
    region.dstOffsets[1] = corner(image_size);
    const bool same = size.width == image_size.width && size.height == image_size.height;
    vkCmdBlitImage(commands, renderer.colour_image(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                   same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

WindowShell::WindowShell(const ShellOptions& options)
    : options_(options),
      text_scale_(options.text_scale.scale),
      window_(options.title, options.width, options.height) {
    (void)choose_language(options.language.code);
    choose_theme(options.theme.is_dark);
    if (!options.has_size)
        options.size.size ? window_.set_own_size(*options.size.size) : window_.fill_screen();
    restart_graphics();
}

WindowShell::~WindowShell() {
    if (!options_.has_size) (void)keep_choice(options_.size.remember, window_.own_size());
}

void WindowShell::restart_graphics() {
    keep_validation_messages();
    graphics_.reset();
    graphics_ = std::make_unique<Graphics>(window_, options_.validation, text_scale_);
}

void WindowShell::run(double most_frames_per_s, const std::function<bool()>& frame,
                      const std::function<void()>& on_lost) {
    const auto shortest = std::chrono::duration_cast<SteadyClock::duration>(
        std::chrono::duration<double>(1 / most_frames_per_s));
    constexpr int most_losses = 3;  // without a picture in between
    int losses = 0;
    SteadyClock::time_point next = SteadyClock::now();
    note_interrupts();
    while (noted_interrupt() == 0) {
        try {
            if (losses > 0 || !graphics_) restart_graphics();
            if (!frame()) return;
            losses = 0;
        } catch (const DeviceLost&) {
            if (++losses > most_losses) throw;
            on_lost();
        }
        // The display's own pace does not throttle everywhere.
        next = std::max(next + shortest, SteadyClock::now());
        std::this_thread::sleep_until(next);
    }
}

std::string WindowShell::change_text_scale(double scale) {
    // Panels need 900 pixels of width at the usual size; beyond a little more they would be cut.
    constexpr double smallest = 0.7, largest = 4, needed_pixels = 900, too_wide = 1.2;
    const double fits = too_wide * window_.size().width / (needed_pixels * window_.content_scale());
    text_scale_ = std::clamp(scale, smallest, std::clamp(fits, 1.0, largest));
    restart_graphics();
    const std::string problem = keep_choice(options_.text_scale.remember, text_scale_);
    return problem.empty() ? format_translated("text: {:.0f} %", 100 * text_scale_) : problem;
}

std::string WindowShell::change_language(const std::string& code) {
    if (!choose_language(code))
        return fmt::format("there are no texts in the language '{}' on this system", code);
    return keep_choice(options_.language.remember, code);
}

std::string WindowShell::change_theme(bool is_dark) {
    choose_theme(is_dark);
    return keep_choice(options_.theme.remember, is_dark);
}

const Input& WindowShell::poll() {
    const Input& input = window_.poll();
    must_rebuild_ = must_rebuild_ || input.resized;
    for (const KeyPress& press : input.pressed) {
        wants_shot_ = wants_shot_ || press.key == Key::F12;
        if (press.control && press.key == Key::Q) window_.close();
    }
    return input;
}

void WindowShell::show_behind(std::optional<FrameScene> picture, float free_share) {
    if (!picture) return behind_.reset();
    if (!behind_) behind_.emplace();
    behind_->picture = std::move(*picture);  // it turns on from where it is
    behind_->free_share = free_share;
}

void WindowShell::paint_behind(VkCommandBuffer commands, VkImage image) {
    constexpr float turns_per_s = 1 / 24.0F;
    const VkExtent2D size = graphics_->swapchain.size();
    FrameScene& picture = behind_->picture;
    const std::chrono::duration<float> passed = std::chrono::steady_clock::now() - behind_->since;
    OrbitCamera camera;
    camera.azimuth = 2 * std::numbers::pi_v<float> * turns_per_s * passed.count();
    const float aspect =
        static_cast<float>(size.width) / static_cast<float>(std::max(size.height, 1U));
    // Above what is said below of work that goes on.
    const float free_height = behind_->free_share < 1 ? 1 : 0.78F;
    frame_all(camera, picture, {behind_->free_share * aspect, free_height});
    picture.camera = frame_camera(camera, picture);
    picture.camera.centre = {behind_->free_share - 1, 1 - free_height};
    picture.background = colours().background;
    graphics_->renderer.record(commands, picture, size);
    stretch_over(commands, graphics_->renderer, size, image, size);
}

void WindowShell::draw_panels(const std::function<void()>& describe,
                              const std::function<void(VkCommandBuffer, VkImage)>& paint) {
    if (window_.size().width == 0 || window_.size().height == 0) return;
    Graphics& g = *graphics_;
    if (std::exchange(must_rebuild_, false)) g.swapchain.rebuild(window_.size());
    g.ui.begin();
    describe();
    g.ui.end();
    WindowShot shot;
    must_rebuild_ = !g.swapchain.present(
        [&](VkCommandBuffer commands, VkImage image) {
            clear(commands, image);
            if (!paint && !behind_) return;
            VkMemoryBarrier cleared{};
            cleared.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
            cleared.srcAccessMask = cleared.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                 VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &cleared, 0, nullptr, 0,
                                 nullptr);
            paint ? paint(commands, image) : paint_behind(commands, image);
        },
        [&](VkCommandBuffer commands) { g.ui.draw(commands); }, wants_shot_ ? &shot : nullptr);
    if (shot.rgba.empty()) return;
    wants_shot_ = false;
    try {
        notice_ = fmt::format("saved {}", save_screenshot(options_.files_folder, shot).string());
    } catch (const LoadError& error) {
        notice_ = error.what();
    }
}

bool WindowShell::work(const std::string& title,
                       const std::function<void(const StageFunction&)>& task) {
    TaskProgress progress;
    bool is_done = true;
    std::future<void> work = worker_.start([&] {
        try {
            task(progress.stages());
        } catch (const Cancelled&) {
            is_done = false;
        }
    });
    const SteadyClock::time_point begin = SteadyClock::now();
    SteadyClock::time_point last_picture = begin;
    longest_pause_ms_ = 0;
    const auto is_ready = [&] {
        return work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    try {
        run(
            panel_frames_per_s,
            [&] {
                const Input& input = poll();
                const auto is_escape = [](const KeyPress& press) {
                    return press.key == Key::Escape;
                };
                if (window_.should_close() || std::ranges::any_of(input.pressed, is_escape))
                    progress.is_cancelled = true;
                const std::chrono::duration<double> passed = SteadyClock::now() - begin;
                draw_panels([&] { progress.draw(title, passed.count(), behind_.has_value()); });
                const std::chrono::duration<double, std::milli> pause =
                    SteadyClock::now() - std::exchange(last_picture, SteadyClock::now());
                longest_pause_ms_ = std::max(longest_pause_ms_, pause.count());
                return !is_ready();
            },
            [] {});
    } catch (...) {
        progress.is_cancelled = true;
        work.wait();
        throw;
    }
    if (!is_ready()) progress.is_cancelled = true;  // a signal ended the loop
    work.get();
    return is_done;
}

void WindowShell::keep_validation_messages() {
    if (!graphics_) return;
    for (const std::string& message : graphics_->device.validation_messages())
        validation_messages_.push_back(message);
}

void WindowShell::check_validation() {
    keep_validation_messages();
    if (!validation_messages_.empty()) throw GpuError("validation: " + validation_messages_[0]);
}

}  // namespace palpa
