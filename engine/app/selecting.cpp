#include "app/selecting.h"

#include "app/marks.h"
#include "app/notices.h"
#include "app/panels.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "ui/colours.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr float least_box = 4;  // pixels; a smaller one is a click

bool has_any(const std::vector<bool>& chosen) {
    return std::ranges::find(chosen, true) != chosen.end();
}

}  // namespace

void select_atoms_by(World& app, const std::string& expression) {
    SelectionState& selection = app.write<SelectionState>();
    selection.problem.clear();
    if (trimmed(expression).empty()) {
        selection.atoms.clear();
        selection.expression.clear();
        selection.count.clear();
        return;
    }
    try {
        const World world = session_of(app).copy_world();  // may be ahead of the frame
        std::vector<bool> chosen = select_as_seen(world, expression);
        if (!has_any(chosen)) {
            selection.problem = selection.atoms.empty()
                                    ? translated("no atom matches this expression")
                                    : format_translated("no atom matches; {} is still selected",
                                                        selection.expression);
            return;
        }
        selection.expression = expression;
        selection.count = describe_count(*list_atoms(world), chosen);
        selection.atoms = std::move(chosen);
    } catch (const LoadError& error) {
        selection.problem = error.what();
    }
}

void select_anew(World& app) {
    SelectionState& selection = app.write<SelectionState>();
    const auto& atoms = frame_of(app).atoms;
    if (!has_frame(app) || selection.known_atoms == atoms) return;
    const bool is_first = !selection.known_atoms;
    selection.known_atoms = atoms;
    if (is_first) return;
    app.write<Measuring>().atoms.clear();  // numbers of atoms have changed
    app.write<SavedViewState>().framed.clear();
    app.write<PictureState>().sent = {};  // molecules that were left out may be back
    if (selection.atoms.empty()) return;
    selection.atoms.clear();
    select_atoms_by(app, std::exchange(selection.expression, {}));
}

bool end_selection(World& app) {
    const bool is_there = !app.resource<SelectionState>().atoms.empty();
    select_atoms_by(app, {});
    return is_there;
}

bool drag_box(World& app, const Input& input) {
    SelectionState& selection = app.write<SelectionState>();
    const bool is_free = has_frame(app) && !app.resource<WindowHands>().holds &&
                         !app.resource<Dialogs>().is_open() && !is_study(app) &&
                         !app.resource<Pointer>().drags_panel;
    for (const MousePress& press : input.clicked)
        if (is_free && press.button == MouseButton::Left && press.control)
            selection.box = {{{press.x, press.y}, {press.x, press.y}}, press.shift};
    if (!selection.box) return false;
    selection.box->corners.other = glm::vec2(input.mouse_x, input.mouse_y);
    if (input.is_down(MouseButton::Left)) return true;
    const auto [corners, adds] = *std::exchange(selection.box, std::nullopt);
    const glm::vec2 size = glm::abs(corners.one - corners.other);
    if (std::max(size.x, size.y) < least_box) return false;
    const LiveFrame& frame = frame_of(app);
    const VkExtent2D window = shell_of(app).window().size();
    std::vector<bool> chosen = find_in_box(app.resource<PictureState>().shown, frame.places,
                                           corners, window.width, window.height);
    if (adds && selection.atoms.size() == chosen.size())
        for (std::size_t i = 0; i < chosen.size(); ++i)
            if (selection.atoms[i]) chosen[i] = true;
    select_atoms_by(app, has_any(chosen) ? expression_of(*frame.atoms, chosen) : "");
    open_panel(app, "select");
    return true;
}

void draw_box(const World& app) {
    const auto& box = app.resource<SelectionState>().box;
    if (!box) return;
    const ImU32 line = colours().selection;
    const ImU32 ground = (line & ~IM_COL32_A_MASK) | (30U << IM_COL32_A_SHIFT);
    const glm::vec2 low = glm::min(box->corners.one, box->corners.other);
    const glm::vec2 high = glm::max(box->corners.one, box->corners.other);
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled({low.x, low.y}, {high.x, high.y}, ground);
    list.AddRect({low.x, low.y}, {high.x, high.y}, line);
}

void label_atom(World& app, std::uint32_t atom) {
    const AtomDirectory& atoms = *frame_of(app).atoms;
    ViewAdditions additions = app.resource<ViewAdditions>();
    const std::string expression = expression_of(atoms, atom);
    const auto before = std::ranges::find(additions.labels, expression);
    const std::string name = to_string(atoms.names[atom]);
    if (before == additions.labels.end()) {
        additions.labels.push_back(expression);
        tell(app, format_translated("{} is labelled; Alt+click again removes the label", name));
    } else {
        additions.labels.erase(before);
        tell(app, format_translated("label of {} removed", name));
    }
    set_additions(app, std::move(additions));
}

}  // namespace palpa
