#include "app/menu_bar.h"

#include "app/actions.h"
#include "app/notices.h"
#include "app/panels.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/icons.h"
#include "ui/legend_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <string>
#include <vector>

namespace palpa {
namespace {

constexpr ImGuiWindowFlags bar = fixed_panel | ImGuiWindowFlags_NoTitleBar |
                                 ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoCollapse |
                                 ImGuiWindowFlags_NoBringToFrontOnFocus;

void draw_menu(World& app, Menu menu) {
    for (const Action& action : list_actions()) {
        if (action.menu != menu) continue;
        const bool is_on = action.is_on && action.is_on(app);
        if (ImGui::MenuItem(labelled(action.text).c_str(), keys_of(action).c_str(), is_on,
                            is_possible(app, action)))
            request(app, action, By::Menu);
        tip(translated(action.explains));
    }
    if (menu != Menu::View) return;
    ImGui::Separator();
    for (const Panel* const panel : list_panels()) {
        if (panel->side == Side::Over) continue;
        if (ImGui::MenuItem(labelled(panel->title).c_str(), nullptr, is_panel_open(app, panel->id),
                            !panel->is_there || panel->is_there(app)))
            toggle_panel(app, panel->id);
        tip(translated(panel->explains));
    }
}

}  // namespace

float draw_menu_bar(World& app) {
    if (!ImGui::BeginMainMenuBar()) return 0;
    for (std::size_t i = 0; i < menus; ++i) {
        if (!ImGui::BeginMenu(labelled(name_of(static_cast<Menu>(i))).c_str())) continue;
        draw_menu(app, static_cast<Menu>(i));
        ImGui::EndMenu();
    }
    const float height = ImGui::GetWindowSize().y;
    ImGui::EndMainMenuBar();
    return height;
}

float draw_toolbar(World& app, float top) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float height = ImGui::GetFrameHeight() + 2 * scaled(4);
    ImGui::SetNextWindowPos({0, top});
    ImGui::SetNextWindowSize({ImGui::GetIO().DisplaySize.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {style.WindowPadding.x, scaled(4)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("##toolbar", nullptr, bar);
    const Action* before = nullptr;
    for (const Action& action : list_actions()) {
        if (*action.icon == '\0') continue;
        if (before) ImGui::SameLine(0, before->menu == action.menu ? scaled(3) : scaled(14));
        before = &action;
        const bool is_on = action.is_on && action.is_on(app);
        ImGui::BeginDisabled(!is_possible(app, action));
        const std::string state = action.state ? action.state(app) : std::string();
        const std::string label = state.empty() ? action.icon : action.icon + ("  " + state);
        // The button is as wide whatever it says, so that no icon moves under the mouse.
        const float width =
            state.empty()
                ? scaled(28)
                : ImGui::CalcTextSize(format_translated("{}, {} left", "888 MB", "888 GB").c_str())
                          .x +
                      scaled(36);
        if (icon_button(label.c_str(), std::string(action.id).c_str(), {width, 0}, is_on))
            request(app, action, By::Toolbar);
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
            const std::string keys = keys_of(action);
            ImGui::SetTooltip("%s%s\n%s", translated(action.text),
                              keys.empty() ? "" : fmt::format(" ({})", keys).c_str(),
                              translated(action.explains));
        }
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
    return height;
}

float draw_status_bar(World& app) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float height = ImGui::GetFrameHeight() + scaled(2);
    ImGui::SetNextWindowPos({0, screen.y - height});
    ImGui::SetNextWindowSize({screen.x, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                        {ImGui::GetStyle().WindowPadding.x, scaled(3)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("##status", nullptr, bar);
    const std::string message = find_message(app);
    ImGui::TextUnformatted(message.c_str());
    tip(message.c_str());
    if (ImGui::IsItemClicked()) open_panel(app, "messages");
    ImGui::End();
    ImGui::PopStyleVar(2);
    return height;
}

namespace {

// Draws the warnings of this moment in the upper part of the picture.
void draw_warnings(World& app, const ScreenArea& area) {
    std::vector<std::string> warnings = list_warnings(app);
    if (!app.resource<Docks>().is_shown) warnings.push_back(find_message(app));
    if (warnings.empty()) return;
    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = std::max(scaled(240), area.width() - 2 * panel_edge());
    const float wrap = width - 2 * style.WindowPadding.x;
    // The library would know the size of new words only in the next frame.
    ImVec2 size{scaled(200), 2 * style.WindowPadding.y - style.ItemSpacing.y};
    for (const std::string& warning : warnings) {
        const ImVec2 words = ImGui::CalcTextSize(warning.c_str(), nullptr, false, wrap);
        size.x = std::max(size.x, std::min(words.x + 1, wrap) + 2 * style.WindowPadding.x);
        size.y += words.y + style.ItemSpacing.y;
    }
    ImGui::SetNextWindowPos({0.5F * (area.left + area.right), area.top + panel_edge()},
                            ImGuiCond_Always, {0.5F, 0});
    ImGui::SetNextWindowSize({size.x, std::min(size.y, 0.6F * area.height())});
    ImGui::Begin("##warnings", nullptr,
                 fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(style.WindowPadding.x + wrap);
    for (const std::string& warning : warnings) ImGui::TextUnformatted(warning.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

// A red mark and the time, in the lower right corner of the picture.
void draw_recording(double seconds, const ScreenArea& area) {
    const auto whole = static_cast<int>(seconds);
    const std::string text = format_translated("recording {}:{:02}", whole / 60, whole % 60);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float radius = 0.4F * size.y;
    const ImVec2 corner{area.right - panel_edge() - size.x, area.bottom - panel_edge() - size.y};
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    constexpr ImU32 red = IM_COL32(200, 20, 20, 255);
    list.AddCircleFilled({corner.x - 2 * radius, corner.y + 0.5F * size.y}, radius, red);
    list.AddText(corner, red, text.c_str());
}

}  // namespace

void draw_warnings_and_legend(World& app) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const ScreenArea area = app.resource<Docks>().picture_area(screen.x, screen.y);
    draw_warnings(app, area);
    if (app.resource<Docks>().is_shown) draw_legend_panel(frame_of(app).legend, area);
    if (const auto state = session_of(app).recording()) draw_recording(state->recorded_s, area);
}

}  // namespace palpa
