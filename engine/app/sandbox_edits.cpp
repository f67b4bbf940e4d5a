// What a person takes, adds and removes.
#include "app/sandbox.h"

#include "core/load_error.h"
#include "core/translate.h"
#include "loading/molecules.h"
#include "loading/sources.h"
#include "scene/find_scene.h"
#include "view/find_room.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

Vec3 as_double(const glm::vec3& v) { return {v.x, v.y, v.z}; }

// Its atoms from its reference atom; none where they cannot be known.
std::vector<Vec3> find_shape(const AddEdit& edit, const LiveFrame& frame) {
    std::vector<Vec3> shape;
    if (!edit.copy_of.empty()) {
        const AtomDirectory::Entry* const original = find_molecule(*frame.atoms, edit.copy_of);
        if (!original) return {};
        const Vec3 reference = as_double(frame.places[original->reference_atom]);
        for (std::uint32_t i = 0; i < original->atoms.count; ++i)
            shape.push_back(as_double(frame.places[original->atoms.first + i]) - reference);
        return shape;
    }
    try {
        const Source source =
            edit.structure.empty()
                ? build_residue(*frame.atoms->force_field, edit.residue, edit.name)
                : read_segment(edit.structure, edit.topology, edit.segment, edit.name);
        AtomTable atoms;
        (void)add_segment_atoms(*frame.atoms->force_field, source, atoms);
        for (const Vec3& place : atoms.positions) shape.push_back(place - atoms.positions.front());
    } catch (const LoadError&) {  // the simulation will say so
        shape.clear();
    }
    return shape;
}

// How far from the middle of what is seen.
std::string describe_way(double angstrom, const OrbitCamera& camera) {
    const double seen = camera.distance * std::tan(0.5 * camera.vertical_angle);
    if (angstrom < 0.6 * seen) return translated("near the middle of the picture");
    return format_translated("{:.0f} Å from the middle of the picture (A shows everything)",
                             angstrom);
}

}  // namespace

// At a pixel of the window.
std::optional<std::uint32_t> Sandbox::find_atom(double x, double y) {
    const VkExtent2D window = shell_.graphics()->swapchain.size();
    if (drawn_size_.width == 0 || window.width == 0 || window.height == 0 || !frame_.atoms)
        return std::nullopt;
    shell_.graphics()->swapchain.wait();
    const std::uint32_t pick = shell_.graphics()->renderer.pick(
        static_cast<std::uint32_t>(std::max(x, 0.0) * drawn_size_.width / window.width),
        static_cast<std::uint32_t>(std::max(y, 0.0) * drawn_size_.height / window.height));
    if (pick >= frame_.atoms->names.size()) return std::nullopt;  // nothing, or a sign
    return pick;
}

// A click takes what is there, unless another one follows that makes both a double click.
void Sandbox::click(const MouseClick& click) {
    const bool pins = click.is_right || click.alt;
    if ((click.is_second && !pins) || options_.study ||
        shell_.graphics()->ui.covers(click.x, click.y))
        return;
    const std::optional<std::uint32_t> atom = find_atom(click.x, click.y);
    if (!atom) return;
    if (pins) return pin(*atom);
    const AtomScope scope = click.control ? AtomScope::Atom
                            : click.shift ? AtomScope::Residue
                                          : AtomScope::Molecule;
    constexpr std::chrono::duration<double> wait{double_click_s};
    wanted_ = {address_of(*frame_.atoms, *atom, scope),
               SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(wait)};
}

void Sandbox::take_clicked() {
    if (!wanted_ || SteadyClock::now() < wanted_->when) return;
    const std::string address = wanted_->address;
    wanted_.reset();
    if (!address.empty() && address != in_hand().held_address) take(address);
}

// What happens in a recorded session is what was recorded.
bool Sandbox::refuse_in_replay() {
    if (!options_.replay) return false;
    notice(translated("a recorded session is played again: nothing can be changed in it"));
    return true;
}

void Sandbox::take(const std::string& address) {
    if (refuse_in_replay()) return;
    edit(GrabEdit{address});
}

void Sandbox::release() {
    if (refuse_in_replay()) return;
    if (frame_.readout.holds_something) edit(ReleaseEdit{});
}

void Sandbox::put_back() {
    if (refuse_in_replay()) return;
    if (!frame_.readout.holds_something)
        return notice(translated("nothing is in hand that could go back: click on an atom first"));
    edit(PutBackEdit{});
}

// The mouse's hand stays where the handle is: it pulls at nothing else.
void Sandbox::edit(EditAction action) {
    rest_all();
    EditDescription description = edit_now(std::move(action));
    description.hand = led_;
    session_.send(description);
}

std::string Sandbox::molecule_in_hand() const {
    const AtomRange& held = in_hand().held;
    return held.count > 0 ? address_of(*frame_.atoms, held.first, AtomScope::Molecule)
                          : std::string();
}

void Sandbox::open_add_panel() {
    if (refuse_in_replay()) return;
    if (has_frame_) add_panel_.open(*frame_.atoms, molecule_in_hand());
}

void Sandbox::take_dropped(const Input& input) {
    if (input.dropped.empty() || options_.study || question_ || !has_frame_) return;
    if (options_.replay) return ask_to_leave("go on", NextScreen{input.dropped});
    // What lacks something on its way into the dialog goes there.
    if (add_panel_.is_open()) return add_panel_.open(input.dropped);
    ask_about_dropped(input.dropped);
}

void Sandbox::ask_about_dropped(const std::vector<std::filesystem::path>& files) {
    const auto is_scene = [](const std::filesystem::path& file) {
        return can_be_opened(file) && !is_structure(file) && !is_topology(file);
    };
    const auto open = [this, files] { ask_to_leave("go on", NextScreen{files}); };
    if (std::ranges::any_of(files, is_scene)) return open();
    if (std::ranges::none_of(files, can_be_opened)) return add_panel_.open(files);
    question_ = {format_translated("What should Palpa do with {}?", files[0].filename().string()),
                 {{Key::A, translated("Add it to this scene (A)"),
                   [this, files] { add_panel_.open(files); }},
                  {Key::O, translated("Open it as a scene of its own (O)"), open},
                  {Key::Escape, translated("Nothing (Esc)")}}};
}

void Sandbox::add(AddEdit wanted) {
    const std::vector<Vec3> shape = find_shape(wanted, frame_);
    // What it looks like is not known where it will be refused.
    constexpr double gap = 3, gap_of_unknown = 6;
    const std::vector<Vec3> one{Vec3::Zero()};
    const Newcomer newcomer = shape.empty() ? Newcomer{one, gap_of_unknown} : Newcomer{shape, gap};
    const std::optional<Vec3> found = find_room(frame_.places, newcomer, camera_);
    if (!found)
        return notice(translated("there is no room for it near the middle of the picture; move the "
                                 "view and try again"),
                      first_notice_s);
    const Vec3& place = *found;
    std::ranges::copy(place, wanted.at_angstrom.begin());
    const double way = (place - as_double(camera_.target)).norm();
    announced_ = {wanted.name, true, frame_.readout.refused_edits,
                  format_translated("{} was added {}; click on it to take it, Ctrl+Z removes it",
                                    wanted.name, describe_way(way, camera_)),
                  add_panel_.takes()};
    edit(std::move(wanted));
}

void Sandbox::remove_held() {
    if (refuse_in_replay()) return;
    const std::string molecule = molecule_in_hand();
    if (molecule.empty())
        return notice(translated("no molecule is in hand to remove; click on an atom first"));
    announced_ = {molecule, false, frame_.readout.refused_edits,
                  format_translated("{} was removed; Ctrl+Z brings it back", molecule)};
    edit(RemoveEdit{molecule});
}

// A refusal is said by the readout.
void Sandbox::tell_what_was_edited() {
    if (!announced_) return;
    const bool is_there = find_molecule(*frame_.atoms, announced_->molecule) != nullptr;
    if (is_there == announced_->is_there) {
        notice(announced_->text, first_notice_s);
        if (announced_->takes) take(announced_->molecule);
    } else if (frame_.readout.refused_edits == announced_->refused_edits) {
        return;
    }
    announced_.reset();
}

void Sandbox::undo_or_redo(bool undoes) {
    if (refuse_in_replay()) return;
    const std::string& name = undoes ? frame_.readout.undo.undo : frame_.readout.undo.redo;
    const bool is_known = frame_.readout.edit_under_way.empty();
    if (name.empty() && is_known)
        return notice(translated(undoes ? for_translation("there is nothing to undo")
                                        : for_translation("there is nothing to redo")));
    if (is_known) notice(fmt::format("{}: {}", translated(undoes ? "Undo" : "Redo"), name));
    undoes ? edit(UndoEdit{}) : edit(RedoEdit{});
}

void Sandbox::tell_what_is_forgotten() {
    const UndoReadout& undo = frame_.readout.undo;
    if (undo.dropped > std::exchange(forgotten_, undo.dropped))
        notice(format_translated("undo has no room for more and forgets the oldest change: {}",
                                 undo.dropped_name),
               first_notice_s);
}

void Sandbox::tell_what_is_held() {
    if (held_address_ == in_hand().held_address) return;
    const bool is_first = held_address_.empty() && !has_first_picture_;
    held_address_ = in_hand().held_address;
    if (is_first || held_address_.empty()) return;
    notice(format_translated("in hand: {}; Ctrl+Z undoes, G lets go", held_address_));
}

// What lies under a mouse that rests; asking the graphics device for it now and then costs little.
void Sandbox::watch_hover(const Input& input, bool is_free) {
    constexpr std::chrono::milliseconds rest{250};
    const auto now = SteadyClock::now();
    const VkExtent2D size = window_.size();
    const bool is_inside = input.mouse_x >= 0 && input.mouse_y >= 0 && input.mouse_x < size.width &&
                           input.mouse_y < size.height;
    if (!is_free || !is_inside || options_.study || input.mouse_dx != 0 || input.mouse_dy != 0) {
        hover_.clear();
        rests_since_ = now;
    } else if (now - rests_since_ > rest) {
        rests_since_ = now;
        const std::optional<std::uint32_t> atom = find_atom(input.mouse_x, input.mouse_y);
        hover_ = atom ? describe_atom(*atom) : std::string();
    }
}

std::string Sandbox::describe_atom(std::uint32_t atom) const {
    std::string text = to_string(frame_.atoms->names[atom]);
    const auto add = [&](AtomScope scope, const char* takes) {
        const std::string address = address_of(*frame_.atoms, atom, scope);
        if (address.empty()) return;
        text += "\n";
        text += address == in_hand().held_address
                    ? format_translated("{} is in hand", address)
                    : fmt::format(fmt::runtime(translated(takes)), address);
    };
    add(AtomScope::Molecule, for_translation("click takes {}"));
    add(AtomScope::Residue, for_translation("Shift+click takes {} by a spring"));
    add(AtomScope::Atom, for_translation("Ctrl+click takes {} by a spring"));
    text += "\n" + std::string(translated("Alt+click or right click names it"));
    return text;
}

}  // namespace palpa
