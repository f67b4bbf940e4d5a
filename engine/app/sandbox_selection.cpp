// What a person selects, and names.
#include "app/sandbox.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace palpa {
namespace {

constexpr float least_box = 4;  // pixels; a smaller one is a click
constexpr float room_around = 1.3F;

void draw_rectangle(const PictureBox& box) {
    constexpr ImU32 line = IM_COL32(190, 0, 120, 255), ground = IM_COL32(190, 0, 120, 30);
    const ImVec2 one{box.one.x, box.one.y}, other{box.other.x, box.other.y};
    const ImVec2 low{std::min(one.x, other.x), std::min(one.y, other.y)};
    const ImVec2 high{std::max(one.x, other.x), std::max(one.y, other.y)};
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled(low, high, ground);
    list.AddRect(low, high, line);
}

}  // namespace

void Sandbox::open_selection() {
    if (has_frame_) selection_panel_.open();
}

// What is wrong with an expression is said, and what was selected before stays.
void Sandbox::select(const std::string& expression) {
    selection_.problem.clear();
    if (trimmed(expression).empty()) {
        selected_.clear();
        selection_ = {};
        return;
    }
    try {
        const World world = session_.copy_world();  // may be ahead of the frame that is shown
        std::vector<bool> chosen = select_as_seen(world, expression);
        if (std::ranges::find(chosen, true) == chosen.end()) {
            selection_.problem = selected_.empty()
                                     ? translated("no atom matches this expression")
                                     : format_translated("no atom matches; {} is still selected",
                                                         selection_.expression);
            return;
        }
        selection_ = {expression, describe_count(*list_atoms(world), chosen), {}};
        selected_ = std::move(chosen);
    } catch (const LoadError& error) {
        selection_.problem = error.what();
    }
}

// Once molecules were added or removed numbers mean other atoms.
void Sandbox::select_anew() {
    if (!has_frame_ || known_atoms_ == frame_.atoms) return;
    const bool is_first = !known_atoms_;
    known_atoms_ = frame_.atoms;
    if (is_first) return;
    framed_.clear();
    sent_ = {};  // of what was left out, molecules may be back
    if (selected_.empty()) return;
    selected_.clear();
    select(std::exchange(selection_, {}).expression);
}

// False where nothing is selected, and the panel is closed.
bool Sandbox::end_selection() {
    const bool is_there = !selected_.empty() || selection_panel_.is_open();
    select({});
    if (selection_panel_.is_open()) selection_panel_.close();
    return is_there;
}

void Sandbox::add_to_picture(ViewAdditions additions) {
    if (overlay_.set_additions(additions)) session_.send(std::move(additions));
}

void Sandbox::draw_selection() {
    if (box_) draw_rectangle(box_->corners);
    const SelectionOrder order =
        selection_panel_.draw(selection_, overlay_.additions(), free_area());
    if (order.select) {
        if (order.select->empty()) selection_panel_.show({});
        select(*order.select);
    }
    if (order.additions) add_to_picture(*order.additions);
    if (order.focus) look_at_selected_or_ligand();
}

// Whether the mouse draws a box, with Ctrl held as it began.
bool Sandbox::draw_box(const Input& input) {
    const glm::vec2 mouse(input.mouse_x, input.mouse_y);
    for (const MousePress& press : input.clicked) {
        const bool begins = press.button == MouseButton::Left && press.control && has_frame_ &&
                            !holding_ && !is_asked() && !options_.study && !drags_panel_;
        if (begins) box_ = Box{{{press.x, press.y}, {press.x, press.y}}, press.shift};
    }
    if (!box_) return false;
    box_->corners.other = mouse;
    if (input.is_down(MouseButton::Left)) return true;
    const auto [corners, adds] = *std::exchange(box_, std::nullopt);
    const glm::vec2 size = glm::abs(corners.one - corners.other);
    if (std::max(size.x, size.y) < least_box) return false;
    const VkExtent2D window = window_.size();
    std::vector<bool> chosen =
        find_in_box(shown_, frame_.places, corners, window.width, window.height);
    if (adds && selected_.size() == chosen.size())
        for (std::size_t i = 0; i < chosen.size(); ++i)
            if (selected_[i]) chosen[i] = true;
    const bool is_empty = std::ranges::find(chosen, true) == chosen.end();
    const std::string expression = is_empty ? "" : expression_of(*frame_.atoms, chosen);
    selection_panel_.show(expression);
    select(expression);
    return true;
}

// Or no longer, where it is.
void Sandbox::pin(std::uint32_t atom) {
    ViewAdditions additions = overlay_.additions();
    const std::string expression = expression_of(*frame_.atoms, atom);
    const auto before = std::ranges::find(additions.labels, expression);
    const std::string name = to_string(frame_.atoms->names[atom]);
    if (before == additions.labels.end()) {
        additions.labels.push_back(expression);
        notice(format_translated("{} is labelled; Alt+click again removes the label", name));
    } else {
        additions.labels.erase(before);
        notice(format_translated("label of {} removed", name));
    }
    add_to_picture(std::move(additions));
}

void Sandbox::look_at_selected_or_ligand() {
    if (!has_frame_) return;
    std::vector<bool> wanted = selected_;
    if (wanted.empty()) wanted = find_framed("ligand");
    std::vector<SphereShape> balls;
    for (std::size_t i = 0; i < std::min(wanted.size(), frame_.places.size()); ++i)
        if (wanted[i]) balls.push_back({frame_.places[i], 1.7F});
    if (balls.empty())
        return notice(translated(
            "nothing is selected and the scene has no ligand; select atoms first (Ctrl+F)"));
    OrbitCamera camera = camera_;
    frame_shapes(camera, balls, free_room());
    zoom(camera, room_around);
    take_camera();
    fly_to(camera);
}

}  // namespace palpa
