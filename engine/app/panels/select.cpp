// The panel "Select": selects atoms by an expression, draws, hides, labels and centres them.
#include "molecule/select.h"
#include "app/panels.h"
#include "app/selecting.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/text.h"
#include "core/translate.h"
#include "ui/choose.h"
#include "ui/colours.h"
#include "ui/icons.h"
#include "ui/shown_names.h"
#include "ui/text_field.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace palpa {
namespace {

struct SelectState {
    std::string text;            // of the field
    std::string shown;           // the selection that the field has shown last
    bool wants_focus = false;    // the field waits for the keys, which nothing else gets
    std::optional<Key> pressed;  // in the field, since the last drawing
    Representation representation = Representation::Licorice;
    std::optional<Colouring> colouring;  // none: the colours of the scene
};

// A button with an English text; beside the one before if there is room.
bool button(const char* text, bool is_first = false) {
    if (!is_first) same_line_if_it_fits(translated(text));
    return ImGui::Button(labelled(text).c_str());
}

void type_expression(World& app, SelectState& state) {
    const SelectionState& selection = app.resource<SelectionState>();
    if (state.wants_focus) ImGui::SetKeyboardFocusHere();
    if (state.shown != selection.expression) state.text = state.shown = selection.expression;
    const std::string before = state.text;
    (void)type_text("##expression", translated("protein and within 5 of ligand"), state.text,
                    ImGuiInputTextFlags_AutoSelectAll);
    if (ImGui::IsItemActive()) state.wants_focus = false;
    const bool is_typed = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
    const std::optional<Key> pressed = std::exchange(state.pressed, std::nullopt);
    if (is_typed && pressed == Key::Enter)
        request(app, [text = std::string(trimmed(state.text))](World& later) {
            select_atoms_by(later, text);
        });
    // Ends typing; the library would take the text back.
    if (is_typed && pressed == Key::Escape) state.text = before;
    if (ImGui::IsItemActive() && pressed) ImGui::ClearActiveID();
    if (!selection.problem.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, colours().wrong);
        ImGui::TextWrapped("%s", selection.problem.c_str());
        ImGui::PopStyleColor();
    } else if (!selection.expression.empty()) {
        ImGui::TextWrapped("%s", selection.count.c_str());
    } else {
        const std::string hint(selection_examples);
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        ImGui::TextWrapped(translated("Enter selects: %s; or Ctrl+drag a box"), hint.c_str());
        ImGui::PopStyleColor();
    }
}

void choose_look(SelectState& state) {
    const float half = 0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
    ImGui::SetNextItemWidth(half);
    (void)choose("##representation", representation_names.size(), state.representation,
                 [](Representation each) { return shown_name(each); });
    ImGui::SameLine();
    ImGui::SetNextItemWidth(half);
    const char* const usual = translated("colours of the scene");
    const auto name = [](Colouring colouring) {
        return format_translated("by {}", shown_name(colouring));
    };
    if (ImGui::BeginCombo("##colour", state.colouring ? name(*state.colouring).c_str() : usual)) {
        if (ImGui::Selectable(usual, !state.colouring)) state.colouring.reset();
        for (std::size_t i = 0; i < colouring_names.size(); ++i) {
            const auto each = static_cast<Colouring>(i);
            if (ImGui::Selectable(name(each).c_str(), state.colouring == each))
                state.colouring = each;
        }
        ImGui::EndCombo();
    }
}

void draw_buttons(World& app, const SelectState& state) {
    const std::string& selected = app.resource<SelectionState>().expression;
    ViewAdditions changed = app.resource<ViewAdditions>();
    const auto add_new = [](auto& items, const auto& item) {
        if (std::ranges::find(items, item) == items.end()) items.push_back(item);
    };
    const auto add_layer = [&] {
        add_new(changed.layers, ViewLayer{.representation = state.representation,
                                          .of = selected,
                                          .colouring = state.colouring});
    };
    const auto hide = [&] { add_new(changed.hidden, selected); };
    if (button(for_translation("Add this representation"), true)) add_layer();
    tip(translated("draws the selection in this representation, in addition to the others"));
    if (button(for_translation("Show only this"))) hide(), add_layer();
    tip(translated("draws the selection in this representation only"));
    if (button(for_translation("Hide"))) hide();
    if (button(for_translation("Label"))) add_new(changed.labels, selected);
    tip(translated("labels the selected residues, or a single atom"));
    if (button(for_translation("Centre"))) request(app, action_called("centre"));
    if (button(for_translation("Clear (Esc)"))) request(app, action_called("select-nothing"));
    if (changed != app.resource<ViewAdditions>()) set_additions(app, std::move(changed));
}

void draw_select(World& app) {
    SelectState& state = panel_state<SelectState>(app);
    type_expression(app, state);
    ImGui::BeginDisabled(app.resource<SelectionState>().expression.empty());
    choose_look(state);
    draw_buttons(app, state);
    ImGui::EndDisabled();
}

void focus_field(World& app) { panel_state<SelectState>(app).wants_focus = true; }

bool press_in_select(World& app, const KeyPress& press) {
    if (!types_text() && !panel_state<SelectState>(app).wants_focus) return false;
    if (press.key == Key::Enter || press.key == Key::Escape)
        panel_state<SelectState>(app).pressed = press.key;
    return true;
}

}  // namespace

extern const Panel select_panel{.id = "select",
                                .title = for_translation("Select"),
                                .explains = for_translation("Atoms by an expression."),
                                .icon = icon_search,
                                .side = Side::Bottom,
                                .draw = draw_select,
                                .is_open = false,
                                .take_keys = focus_field,
                                .press = press_in_select};

}  // namespace palpa
