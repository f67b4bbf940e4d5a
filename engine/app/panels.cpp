#include "app/panels.h"

#include "app/actions.h"
#include "app/menu_bar.h"
#include "app/window_world.h"
#include "core/text.h"
#include "core/translate.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

namespace palpa {

extern const Panel tree_panel, inspector_panel, hand_panel, coupling_panel, plots_panel,
    machine_panel, lesson_panel, time_line_panel, select_panel, messages_panel, keys_panel,
    search_panel, picture_panel;

namespace {

constexpr const Panel* panels[] = {
    &tree_panel,       // molecules, hands, restraints, marks, layers
    &hand_panel,       // force, energy, work
    &inspector_panel,  // components of what is selected
    &coupling_panel,   // the laws between molecule and hand
    &plots_panel,      // forces over time and distance
    &machine_panel,    // device, servo, graphics
    &lesson_panel,     // the present step
    &time_line_panel,  // of a replay or a trajectory
    &select_panel,     // atoms by an expression
    &messages_panel,   // all messages so far
    &keys_panel,       // keys and mouse
    &search_panel,     // every action and scene key
    &picture_panel,    // to be saved without panels
};

constexpr std::array<std::string_view, 3> side_names{"left", "right", "bottom"};
constexpr float strip_width = 30, splitter = 6;  // pixels at the usual size of text

bool is_there(const World& app, const Panel& panel) {
    const auto& is_open = app.resource<Docks>().is_open;
    return is_open.at(panel.id) && (!panel.is_there || panel.is_there(app));
}

const Panel& panel_called(std::string_view id) {
    return **std::ranges::find(panels, id, [](const Panel* panel) { return panel->id; });
}

std::vector<const Panel*> list_at(const World& app, Side side) {
    std::vector<const Panel*> found;
    for (const Panel* const panel : panels)
        if (panel->side == side && is_there(app, *panel)) found.push_back(panel);
    return found;
}

// The usual extent of a dock in pixels: at least 60 % of the width is picture.
float usual_size(Side side, const ImVec2& screen) {
    if (side == Side::Left) return std::min(scaled(200), 0.15F * screen.x);
    if (side == Side::Right) return std::min(scaled(310), 0.24F * screen.x);
    return std::clamp(0.26F * screen.y, scaled(130), scaled(230));
}

float dock_size(const Docks& docks, Side side, const ImVec2& screen) {
    const auto set = docks.size.find(side);
    const float largest = side == Side::Bottom ? 0.45F * screen.y : 0.4F * screen.x;
    if (set == docks.size.end() || set->second <= 0) return usual_size(side, screen);
    return std::min(std::max(scaled(set->second), scaled(100)), largest);
}

// A dock collapses to its icons in a window too small for it.
bool is_folded(const Docks& docks, Side side, const ImVec2& screen) {
    if (side == Side::Bottom) return false;
    constexpr float least_width = 840;  // pixels at the usual size of text
    const auto set = docks.is_folded.find(side);
    return set != docks.is_folded.end() ? set->second : screen.x < scaled(least_width);
}

constexpr ImGuiWindowFlags dock_flags =
    fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar |
    ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoBringToFrontOnFocus;

void draw_strip(World& app, Side side, const std::vector<const Panel*>& here, const ImVec2& corner,
                const ImVec2& size) {
    ImGui::SetNextWindowPos(corner);
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {scaled(3), scaled(4)});
    ImGui::Begin(side == Side::Left ? "##left strip" : "##right strip", nullptr, dock_flags);
    for (const Panel* const panel : here) {
        if (icon_button(panel->icon, std::string(panel->id).c_str(), {-1, 0})) {
            Docks& docks = app.write<Docks>();
            docks.is_folded[side] = false;
            docks.wants_front[side] = panel->id;
        }
        tip(translated(panel->title));
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

// Lets a person drag the edge between a dock and the picture.
void drag_edge(World& app, Side side, const ImVec2& corner, const ImVec2& size) {
    const bool is_bottom = side == Side::Bottom;
    const ImVec2 end{corner.x + size.x, corner.y + size.y};
    ImGui::SetCursorScreenPos(corner);
    ImGui::PushClipRect(corner, end, false);  // the library's own leaves out the padding
    ImGui::InvisibleButton("##edge", size);
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
        ImGui::SetMouseCursor(is_bottom ? ImGuiMouseCursor_ResizeNS : ImGuiMouseCursor_ResizeEW);
        ImGui::GetWindowDrawList()->AddRectFilled(corner, end,
                                                  ImGui::GetColorU32(ImGuiCol_SeparatorHovered));
    }
    ImGui::PopClipRect();
    if (!ImGui::IsItemActive()) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize, moved = ImGui::GetIO().MouseDelta;
    Docks& docks = app.write<Docks>();
    const float way = side == Side::Left ? moved.x : is_bottom ? -moved.y : -moved.x;
    docks.size[side] = (dock_size(docks, side, screen) + way) / scaled(1);
}

void draw_tabs(World& app, Side side, const std::vector<const Panel*>& here) {
    Docks& docks = app.write<Docks>();
    if (!ImGui::BeginTabBar("tabs", ImGuiTabBarFlags_FittingPolicyScroll)) return;
    const std::string_view wanted = std::exchange(docks.wants_front[side], {});
    for (const Panel* const panel : here) {
        const ImGuiTabItemFlags flags =
            wanted == panel->id ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None;
        bool stays = true;
        const bool can_close = side == Side::Bottom;
        const bool is_front = ImGui::BeginTabItem(labelled(panel->title).c_str(),
                                                  can_close ? &stays : nullptr, flags);
        if (!is_front) tip(translated(panel->explains));
        if (is_front) {
            docks.front[side] = panel->id;
            ImGui::BeginChild(panel->title, {0, 0}, false);
            panel->draw(app);
            ImGui::EndChild();
            ImGui::EndTabItem();
        }
        if (!stays) docks.is_open[panel->id] = false;
    }
    if (side != Side::Bottom) {
        if (ImGui::TabItemButton(side == Side::Left ? "«##fold" : "»##fold",
                                 ImGuiTabItemFlags_Trailing | ImGuiTabItemFlags_NoTooltip))
            docks.is_folded[side] = true;
        tip(translated("folds these panels to icons"));
    }
    ImGui::EndTabBar();
}

void draw_dock(World& app, Side side, const std::vector<const Panel*>& here, const ImVec2& corner,
               const ImVec2& size) {
    ImGui::SetNextWindowPos(corner);
    ImGui::SetNextWindowSize(size);
    constexpr const char* names[] = {"##left", "##right", "##bottom"};
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin(names[static_cast<std::size_t>(side)], nullptr, dock_flags);
    ImGui::PopStyleVar();
    draw_tabs(app, side, here);
    const float edge = scaled(splitter);
    const ImVec2 at{side == Side::Left ? corner.x + size.x - edge : corner.x, corner.y};
    drag_edge(app, side, at, side == Side::Bottom ? ImVec2{size.x, edge} : ImVec2{edge, size.y});
    ImGui::End();
}

}  // namespace

std::span<const Panel* const> list_panels() noexcept { return panels; }

Docks build_docks(std::span<const std::string> kept) {
    Docks docks;
    for (const Panel* const panel : panels) docks.is_open[panel->id] = panel->is_open;
    docks.wants_front = {{Side::Right, "hand"}, {Side::Bottom, "lesson"}};
    for (const std::string& line : kept) {
        const std::vector<std::string_view> words = split_words(line);
        if (words.size() != 2) continue;
        const auto panel = docks.is_open.find(words[0]);
        if (panel != docks.is_open.end()) panel->second = words[1] == "open";
        const auto side = std::ranges::find(side_names, words[0]);
        if (side == side_names.end()) continue;
        const auto at = static_cast<Side>(side - side_names.begin());
        if (const std::optional<double> size = find_real(words[1]))
            docks.size[at] = static_cast<float>(*size);
        else
            docks.is_folded[at] = words[1] == "folded";
    }
    return docks;
}

std::vector<std::string> list_docks(const Docks& docks) {
    std::vector<std::string> kept;
    const auto name = [](Side side) { return side_names.at(static_cast<std::size_t>(side)); };
    for (const auto& [side, size] : docks.size)
        if (side != Side::Over && size > 0)
            kept.push_back(fmt::format("{} {:.0f}", name(side), size));
    for (const auto& [side, is_folded] : docks.is_folded)
        if (side != Side::Over)
            kept.push_back(fmt::format("{} {}", name(side), is_folded ? "folded" : "unfolded"));
    for (const Panel* const panel : panels) {
        const bool is_open = docks.is_open.at(panel->id);
        if (panel->side != Side::Over && !panel->is_there && is_open != panel->is_open)
            kept.push_back(fmt::format("{} {}", panel->id, is_open ? "open" : "closed"));
    }
    return kept;
}

ScreenArea Docks::picture_area(float width, float height) const {
    const bool is_known = is_shown && picture.width() > 0 && picture.height() > 0 &&
                          picture.right <= width + 1 && picture.bottom <= height + 1;
    return is_known ? picture : ScreenArea{0, 0, width, height};
}

std::vector<PanelRequest> draw_panels(World& app) {
    Docks& kept = app.write<Docks>();
    if (ImGui::GetFrameCount() < std::exchange(kept.last_frame, ImGui::GetFrameCount()))
        kept.wants_front = kept.front;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ScreenArea area{0, 0, screen.x, screen.y};
    if (app.resource<Docks>().is_shown) {
        area.top = draw_menu_bar(app);
        area.top += draw_toolbar(app, area.top);
        area.bottom -= draw_status_bar(app);
        const float height = area.height();
        for (const Side side : {Side::Left, Side::Right}) {
            const std::vector<const Panel*> here = list_at(app, side);
            if (here.empty()) continue;
            const Docks& docks = app.resource<Docks>();
            const bool folds = is_folded(docks, side, screen);
            const float width = folds ? scaled(strip_width) : dock_size(docks, side, screen);
            const ImVec2 corner{side == Side::Left ? 0 : screen.x - width, area.top};
            if (folds)
                draw_strip(app, side, here, corner, {width, height});
            else
                draw_dock(app, side, here, corner, {width, height});
            (side == Side::Left ? area.left : area.right) += side == Side::Left ? width : -width;
        }
        if (const std::vector<const Panel*> here = list_at(app, Side::Bottom); !here.empty()) {
            const float deep = dock_size(app.resource<Docks>(), Side::Bottom, screen);
            area.bottom -= deep;
            draw_dock(app, Side::Bottom, here, {area.left, area.bottom}, {area.width(), deep});
        }
        if (const std::string& hover = app.resource<Pointer>().hover; !hover.empty())
            ImGui::SetTooltip("%s", hover.c_str());
    }
    app.write<Docks>().picture = area;
    for (const Panel* const panel : list_at(app, Side::Over)) panel->draw(app);
    draw_warnings_and_legend(app);
    return std::exchange(app.write<Docks>().requests, {});
}

void request(World& app, PanelRequest what) {
    app.write<Docks>().requests.push_back(std::move(what));
}

void request(World& app, const Action& action, By by) {
    request(app, [&action, by](World& later) { perform(later, action, by); });
}

void bring_forward(World& app, std::string_view id) {
    Docks& docks = app.write<Docks>();
    const Panel& panel = panel_called(id);
    docks.is_open[panel.id] = true;
    docks.wants_front[panel.side] = panel.id;
}

void open_panel(World& app, std::string_view id, bool takes_keys) {
    bring_forward(app, id);
    Docks& docks = app.write<Docks>();
    const Panel& panel = panel_called(id);
    docks.is_shown = true;
    if (is_folded(docks, panel.side, ImGui::GetIO().DisplaySize))
        docks.is_folded[panel.side] = false;
    if (takes_keys && panel.take_keys) panel.take_keys(app);
}

void close_panel(World& app, std::string_view id) { app.write<Docks>().is_open.at(id) = false; }

bool is_panel_open(const World& app, std::string_view id) {
    return app.resource<Docks>().is_open.at(id);
}

bool is_panel_seen(const World& app, std::string_view id) {
    const Docks& docks = app.resource<Docks>();
    const auto front = docks.front.find(panel_called(id).side);
    return docks.is_shown && is_panel_open(app, id) && front != docks.front.end() &&
           front->second == id;
}

void toggle_panel(World& app, std::string_view id) {
    is_panel_open(app, id) ? close_panel(app, id) : open_panel(app, id);
}

bool close_something(World& app) {
    if (ImGui::GetCurrentContext()->OpenPopupStack.Size > 0) {
        ImGui::ClosePopupToLevel(0, true);
        return true;
    }
    const std::vector<const Panel*> over = list_at(app, Side::Over);
    if (!over.empty()) close_panel(app, over.back()->id);  // the later ones lie over the others
    return !over.empty();
}

bool types_text() {
    const ImGuiContext& context = *ImGui::GetCurrentContext();
    return context.ActiveId != 0 && context.ActiveId == context.InputTextState.ID;
}

bool press_in_panels(World& app, const KeyPress& press) {
    for (const bool is_over : {true, false})
        for (const Panel* const panel : panels)
            if (panel->press && (panel->side == Side::Over) == is_over && is_there(app, *panel) &&
                panel->press(app, press))
                return true;
    return types_text();
}

}  // namespace palpa
