#include "ui/backend.h"

#include "render/font_files.h"
#include "ui/colours.h"
#include "ui/icon_font.h"
#include "ui/layout.h"

#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>
#include <imgui_internal.h>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>

namespace palpa {
namespace {

// By its first bytes: the library ends the program over files that are none.
bool is_font(const std::filesystem::path& file) {
    std::array<char, 4> begin{};
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(begin.data(), begin.size())) return false;
    const std::string_view mark(begin.data(), begin.size());
    using namespace std::string_view_literals;
    return mark == "\0\1\0\0"sv || mark == "true" || mark == "OTTO" || mark == "ttcf";
}

// Adds the icons (ui/icons.h) to the font before.
void add_icons(float text_pixels) {
    static constexpr ImWchar ranges[] = {0xF000, 0xF2FF, 0};
    ImFontConfig config;
    config.MergeMode = true;
    config.FontDataOwnedByAtlas = false;
    config.GlyphMinAdvanceX = text_pixels;
    // The library only reads it.
    auto* const data = const_cast<unsigned char*>(icon_font);  // NOLINT
    ImGui::GetIO().Fonts->AddFontFromMemoryTTF(data, sizeof icon_font, 0.9F * text_pixels, &config,
                                               ranges);
}

// The library's own bitmap font is the last resort.
void add_font(float text_pixels) {
    // Latin, Greek, sub- and superscripts, arrows, mathematics: what formulas need.
    static constexpr ImWchar ranges[] = {0x20,   0xFF,   0x370,  0x3FF,  0x2010, 0x2027, 0x2070,
                                         0x209F, 0x2190, 0x21FF, 0x2200, 0x22FF, 0};
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    for (const std::filesystem::path& file : list_font_files())
        if (is_font(file) &&
            atlas.AddFontFromFileTTF(file.string().c_str(), text_pixels, nullptr, ranges))
            return;
    atlas.AddFontDefault();
}

}  // namespace

void set_ui_style(float text_scale) {
    // In whole pixels, as windows are: else their content is a part of one too high for them.
    const float text_pixels = std::round(usual_text * text_scale);
    add_font(text_pixels);
    add_icons(text_pixels);
    set_theme_colours();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 6;
    style.FrameRounding = style.GrabRounding = style.TabRounding = 4;
    style.WindowBorderSize = 0;
    style.WindowMinSize = {4, 4};  // bars and strips of icons are lower than usual windows
    style.WindowPadding = {10, 8};
    style.ItemSpacing = {8, 5};
    style.ScaleAllSizes(text_scale);
}

UiBackend::UiBackend(const Window& window, GpuDevice& device, VkRenderPass pass,
                     std::uint32_t images, float text_scale)
    : device_(device) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = 4;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    check_vulkan(vkCreateDescriptorPool(device.handle(), &pool, nullptr, &descriptors_),
                 "vkCreateDescriptorPool");

    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    set_ui_style(text_scale);
    ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device.instance();
    info.PhysicalDevice = device.physical();
    info.Device = device.handle();
    info.QueueFamily = device.queue_family();
    info.Queue = device.queue();
    info.DescriptorPool = descriptors_;
    info.MinImageCount = 2;
    info.ImageCount = images;
    info.CheckVkResultFn = [](VkResult result) { check_vulkan(result, "the overlay's drawing"); };
    ImGui_ImplVulkan_Init(&info, pass);
    device.submit([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

UiBackend::~UiBackend() {
    vkDeviceWaitIdle(device_.handle());
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    vkDestroyDescriptorPool(device_.handle(), descriptors_, nullptr);
}

void UiBackend::begin(bool has_cursor) {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    constexpr float nowhere = std::numeric_limits<float>::lowest();  // as the library says it
    if (!has_cursor) ImGui::GetIO().MousePos = {nowhere, nowhere};
    ImGui::NewFrame();
}

void UiBackend::end() { ImGui::Render(); }

void UiBackend::draw(VkCommandBuffer commands) {
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

bool UiBackend::covers(double x, double y) const {
    const ImVec2 place{static_cast<float>(x), static_cast<float>(y)};
    for (const ImGuiWindow* const window : ImGui::GetCurrentContext()->Windows) {
        const bool takes_mouse = (window->Flags & ImGuiWindowFlags_NoMouseInputs) == 0;
        if (window->WasActive && !window->Hidden && takes_mouse &&
            window->OuterRectClipped.Contains(place)) {
            return true;
        }
    }
    return false;
}

}  // namespace palpa
