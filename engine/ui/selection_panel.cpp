#include "ui/selection_panel.h"

#include "core/text.h"
#include "core/translate.h"
#include "molecule/select.h"
#include "ui/shown_names.h"
#include "ui/text_field.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr ImU32 wrong_colour = IM_COL32(165, 40, 15, 255);

// A button with an English text; beside the one before, where there is room.
bool button(const char* text, bool is_first = false) {
    if (!is_first) same_line_if_it_fits(translated(text));
    return ImGui::Button(labelled(text).c_str());
}

std::string describe(const ViewLayer& layer) {
    return format_translated("{} of {}", shown_name(layer.representation),
                             layer.of.empty() ? translated("all") : layer.of);
}

// A line of the list; whether it is to be removed.
bool is_removed(const std::string& text) {
    ImGui::PushID(text.c_str());
    const bool pressed = ImGui::SmallButton(labelled("remove").c_str());
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::TextWrapped("%s", text.c_str());
    return pressed;
}

}  // namespace

void SelectionPanel::press(Key key) {
    if (key == Key::Enter || key == Key::Escape) pressed_ = key;
}

void SelectionPanel::open() { is_open_ = wants_focus_ = awaits_keys_ = true; }

// Its field takes no keys from then on.
void SelectionPanel::close() {
    is_open_ = awaits_keys_ = false;
    ImGui::ClearActiveID();
}

void SelectionPanel::show(const std::string& expression) {
    is_open_ = true;
    text_ = expression;
    ImGui::ClearActiveID();  // under way the text would be the library's
}

SelectionOrder SelectionPanel::draw(const SelectionStatus& status, const ViewAdditions& additions,
                                    const ScreenArea& area) {
    SelectionOrder order;
    if (!is_open_) return order;
    const float edge = panel_edge(), screen = ImGui::GetIO().DisplaySize.y;
    const float width = std::min(std::max(area.width() - 2 * edge, scaled(260)), scaled(560));
    ImGui::SetNextWindowPos({0.5F * (area.left + area.right), screen - edge}, ImGuiCond_Always,
                            {0.5F, 1});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, 0.45F * screen});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin(labelled(selection_panel).c_str(), &is_open_,
                 fixed_panel | ImGuiWindowFlags_NoCollapse);
    type_expression(status, order);
    ImGui::BeginDisabled(status.expression.empty());
    choose_look();
    draw_buttons(status, additions, order);
    ImGui::EndDisabled();
    list_additions(additions, order);
    ImGui::End();
    if (!is_open_) close();
    return order;
}

void SelectionPanel::type_expression(const SelectionStatus& status, SelectionOrder& order) {
    if (std::exchange(wants_focus_, false)) ImGui::SetKeyboardFocusHere();
    const std::string before = text_;
    (void)type_text("##expression", translated("protein and within 5 of ligand"), text_,
                    ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemActive()) awaits_keys_ = false;
    const bool is_typed = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
    const std::optional<Key> pressed = std::exchange(pressed_, std::nullopt);
    if (is_typed && pressed == Key::Enter) order.select = trimmed(text_);
    // It ends typing; the library would take the text back.
    if (is_typed && pressed == Key::Escape) text_ = before;
    if (ImGui::IsItemActive() && pressed) ImGui::ClearActiveID();
    if (!status.problem.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, wrong_colour);
        ImGui::TextWrapped("%s", status.problem.c_str());
        ImGui::PopStyleColor();
    } else if (!status.expression.empty()) {
        ImGui::TextWrapped("%s", status.count.c_str());
    } else {
        const std::string hint(selection_examples);
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        ImGui::TextWrapped(translated("Enter selects: %s; or Ctrl+drag a box"), hint.c_str());
        ImGui::PopStyleColor();
    }
}

void SelectionPanel::choose_look() {
    const float half = 0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
    ImGui::SetNextItemWidth(half);
    const auto shape = static_cast<std::size_t>(representation_);
    if (ImGui::BeginCombo("##representation", shown_name(representation_))) {
        for (std::size_t i = 0; i < representation_names.size(); ++i)
            if (ImGui::Selectable(shown_name(static_cast<Representation>(i)), i == shape))
                representation_ = static_cast<Representation>(i);
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(half);
    const char* const usual = translated("colours of the scene");
    const auto name = [](Colouring colouring) {
        return format_translated("by {}", shown_name(colouring));
    };
    if (ImGui::BeginCombo("##colour", colouring_ ? name(*colouring_).c_str() : usual)) {
        if (ImGui::Selectable(usual, !colouring_)) colouring_.reset();
        for (std::size_t i = 0; i < colouring_names.size(); ++i) {
            const auto each = static_cast<Colouring>(i);
            if (ImGui::Selectable(name(each).c_str(), colouring_ == each)) colouring_ = each;
        }
        ImGui::EndCombo();
    }
}

void SelectionPanel::draw_buttons(const SelectionStatus& status, const ViewAdditions& additions,
                                  SelectionOrder& order) {
    ViewAdditions changed = additions;
    const auto add_new = [](auto& items, const auto& item) {
        if (std::ranges::find(items, item) == items.end()) items.push_back(item);
    };
    const auto add_layer = [&] {
        add_new(changed.layers, ViewLayer{.representation = representation_,
                                          .of = status.expression,
                                          .colouring = colouring_});
    };
    const auto hide = [&] { add_new(changed.hidden, status.expression); };
    if (button(for_translation("Add this representation"), true)) add_layer();
    tip(translated("draws the selection in this representation, in addition to the others"));
    if (button(for_translation("Show only this"))) hide(), add_layer();
    tip(translated("draws the selection in this representation only"));
    if (button(for_translation("Hide"))) hide();
    if (button(for_translation("Label"))) add_new(changed.labels, status.expression);
    tip(translated("labels the selected residues, or a single atom"));
    if (button(for_translation("Centre"))) order.focus = true;
    if (button(for_translation("Clear (Esc)"))) order.select = "";
    if (changed != additions) order.additions = std::move(changed);
}

void SelectionPanel::list_additions(const ViewAdditions& additions, SelectionOrder& order) {
    ViewAdditions changed = additions;
    const auto list = [&](auto& items, const auto& describe_one) {
        for (std::size_t i = 0; i < items.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));
            const bool removed = is_removed(describe_one(items[i]));
            ImGui::PopID();
            if (!removed) continue;
            items.erase(items.begin() + static_cast<std::ptrdiff_t>(i));
            break;  // one a frame
        }
    };
    if (additions != ViewAdditions()) ImGui::Separator();
    list(changed.layers, [](const ViewLayer& layer) { return describe(layer); });
    list(changed.hidden, [](const std::string& text) { return translated("hidden: ") + text; });
    list(changed.labels, [](const std::string& text) { return translated("named: ") + text; });
    if (changed != additions) order.additions = std::move(changed);
}

}  // namespace palpa
