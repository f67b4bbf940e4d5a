#include "app/editing.h"

#include "app/fetch_structure.h"
#include "app/hands.h"
#include "app/marks.h"
#include "app/notices.h"
#include "app/open_structure.h"
#include "app/panels.h"
#include "app/saving.h"
#include "app/selecting.h"
#include "app/window_world.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "loading/molecules.h"
#include "loading/sources.h"
#include "scene/find_scene.h"
#include "view/find_room.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace palpa {
namespace {

Vec3 as_double(const glm::vec3& v) { return {v.x, v.y, v.z}; }

// Positions of its atoms from its reference atom; none if they cannot be known.
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

void undo_or_redo(World& app, bool undoes) {
    if (refuse_in_replay(app)) return;
    const UndoReadout& history = frame_of(app).readout.undo;
    const std::string& name = undoes ? history.undo : history.redo;
    if (frame_of(app).readout.edit_under_way.empty())
        tell(app, fmt::format("{}: {}", translated(undoes ? "Undo" : "Redo"), name));
    undoes ? edit_scene(app, UndoEdit{}) : edit_scene(app, RedoEdit{});
}

void announce(World& app, std::string molecule, bool is_added, std::string text,
              bool grabs = false) {
    app.write<PendingEdits>().announced = {
        std::move(molecule), is_added, frame_of(app).readout.refused_edits, std::move(text), grabs};
}

}  // namespace

std::optional<std::uint32_t> find_atom(World& app, double x, double y) {
    Graphics* const graphics = shell_of(app).graphics();
    const VkExtent2D window = graphics->swapchain.size();
    const VkExtent2D drawn = app.resource<PictureState>().drawn_size;
    const LiveFrame& frame = frame_of(app);
    if (drawn.width == 0 || window.width == 0 || window.height == 0 || !frame.atoms)
        return std::nullopt;
    graphics->swapchain.wait();
    const std::uint32_t pick = graphics->renderer.pick(
        static_cast<std::uint32_t>(std::max(x, 0.0) * drawn.width / window.width),
        static_cast<std::uint32_t>(std::max(y, 0.0) * drawn.height / window.height));
    if (pick >= frame.atoms->names.size()) return std::nullopt;
    return pick;
}

std::string describe_atom(const World& app, std::uint32_t atom) {
    const AtomDirectory& atoms = *frame_of(app).atoms;
    std::string text = to_string(atoms.names[atom]);
    const auto add = [&](AtomScope scope, const char* takes) {
        const std::string address = address_of(atoms, atom, scope);
        if (address.empty()) return;
        text += "\n";
        text += address == led_hand(app).held_address
                    ? format_translated("{} is in hand", address)
                    : fmt::format(fmt::runtime(translated(takes)), address);
    };
    if (measures(app)) return text + "\n" + translated("click measures it; I or Esc ends");
    add(AtomScope::Molecule, for_translation("click takes {}"));
    add(AtomScope::Residue, for_translation("Shift+click takes {} by a spring"));
    add(AtomScope::Atom, for_translation("Ctrl+click takes {} by a spring"));
    text += "\n" + std::string(translated("Alt+click or right click names it"));
    return text;
}

bool refuse_in_replay(World& app) {
    if (is_replay(app))
        tell(app, translated("a recorded session is played again: nothing can be changed in it"));
    return is_replay(app);
}

void edit_scene(World& app, EditAction action, std::optional<std::size_t> hand) {
    if (refuse_in_replay(app)) return;
    const bool is_of_looks = std::holds_alternative<AppearanceEdit>(action) ||
                             std::holds_alternative<RenameEdit>(action) ||
                             std::holds_alternative<PinEdit>(action);
    if (!is_of_looks) rest_hands(app);
    EditDescription description = edit_now(std::move(action));
    description.hand = hand.value_or(app.resource<WindowHands>().led);
    send(app, description);
}

void request_edit(World& app, EditAction action) {
    request(app, [action = std::move(action)](World& later) { edit_scene(later, action); });
}

void click_atom(World& app, const MouseClick& click) {
    const bool labels = click.is_right || click.alt;
    if ((click.is_second && !labels) || is_study(app) ||
        shell_of(app).graphics()->ui.covers(click.x, click.y))
        return;
    const std::optional<std::uint32_t> atom = find_atom(app, click.x, click.y);
    if (!atom) return;
    if (labels) return label_atom(app, *atom);
    if (measures(app)) return measure_atom(app, *atom);
    const AtomScope scope = click.control ? AtomScope::Atom
                            : click.shift ? AtomScope::Residue
                                          : AtomScope::Molecule;
    constexpr std::chrono::duration<double> wait{double_click_s};
    app.write<PendingEdits>().click = {
        address_of(*frame_of(app).atoms, *atom, scope),
        SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(wait)};
}

void take_clicked(World& app) {
    std::optional<PendingEdits::Click>& click = app.write<PendingEdits>().click;
    if (!click || SteadyClock::now() < click->when) return;
    const std::string address = click->address;
    click.reset();
    if (!address.empty() && address != led_hand(app).held_address)
        edit_scene(app, GrabEdit{address});
}

void release_held(World& app) {
    if (frame_of(app).readout.holds_something) edit_scene(app, ReleaseEdit{});
}

void put_back_held(World& app) {
    if (!frame_of(app).readout.holds_something)
        return tell(app, translated("nothing is in hand that could go back: click on an atom "
                                    "first"));
    edit_scene(app, PutBackEdit{});
}

void remove_held(World& app) {
    if (refuse_in_replay(app)) return;
    const std::string molecule = molecule_in_hand(app);
    if (molecule.empty())
        return tell(app, translated("no molecule is in hand to remove; click on an atom first"));
    announce(app, molecule, false,
             format_translated("{} was removed; Ctrl+Z brings it back", molecule));
    edit_scene(app, RemoveEdit{molecule});
}

void undo(World& app) { undo_or_redo(app, true); }
void redo(World& app) { undo_or_redo(app, false); }

void open_add_panel(World& app) {
    if (refuse_in_replay(app) || !has_frame(app)) return;
    app.write<Dialogs>().add.open(*frame_of(app).atoms, molecule_in_hand(app));
}

void add_molecule(World& app, AddEdit wanted) {
    const LiveFrame& frame = frame_of(app);
    const OrbitCamera& camera = app.resource<CameraState>().now;
    const std::vector<Vec3> shape = find_shape(wanted, frame);
    // The shape of what will be refused is not known.
    constexpr double gap = 3, gap_of_unknown = 6;
    const std::vector<Vec3> one{Vec3::Zero()};
    const Newcomer newcomer = shape.empty() ? Newcomer{one, gap_of_unknown} : Newcomer{shape, gap};
    const std::optional<Vec3> place = find_room(frame.places, newcomer, camera);
    if (!place)
        return tell(app,
                    translated("there is no room for it near the middle of the picture; move the "
                               "view and try again"),
                    long_notice_s);
    std::ranges::copy(*place, wanted.at_angstrom.begin());
    const double way = (*place - as_double(camera.target)).norm();
    announce(app, wanted.name, true,
             format_translated("{} was added {}; click on it to take it, Ctrl+Z removes it",
                               wanted.name, describe_way(way, camera)),
             app.resource<Dialogs>().add.takes());
    edit_scene(app, std::move(wanted));
}

void take_dropped(World& app, const std::vector<std::filesystem::path>& files) {
    Dialogs& dialogs = app.write<Dialogs>();
    if (files.empty() || is_study(app) || !has_frame(app)) return;
    if (dialogs.question)
        return tell(app, translated("first answer the question, then drop again"));
    const NextScreen next = name_screen(files);
    const auto open = [&app, next] { ask_to_leave(app, next); };
    if (is_replay(app) || !next.code.empty()) return open();
    // A file that the open dialog lacks goes there.
    if (dialogs.add.is_open()) return dialogs.add.open(files);
    const auto is_scene = [](const std::filesystem::path& file) {
        return can_be_opened(file) && !is_structure(file) && !is_topology(file);
    };
    if (std::ranges::any_of(files, is_scene)) return open();
    if (std::ranges::none_of(files, can_be_opened)) return dialogs.add.open(files);
    if (const std::size_t count = split_structures(files).size(); count > 1) {
        dialogs.question = {
            format_translated("Leave this scene, and make a scene of each of {} files?", count),
            {{Key::O, translated("Make them (O)"), open},
             {Key::Escape, translated("Nothing (Esc)")}}};
        return;
    }
    dialogs.question = {
        format_translated("What should Palpa do with {}?", files[0].filename().string()),
        {{Key::A, translated("Add it to this scene (A)"),
          [&app, files] { app.write<Dialogs>().add.open(files); }},
         {Key::O, translated("Open it as a scene of its own (O)"), open},
         {Key::Escape, translated("Nothing (Esc)")}}};
}

void tell_of_edit(World& app) {
    const std::optional<PendingEdits::Announced> announced = app.resource<PendingEdits>().announced;
    if (!announced) return;
    const bool is_there = find_molecule(*frame_of(app).atoms, announced->molecule) != nullptr;
    if (is_there == announced->is_added) {
        tell(app, announced->text, long_notice_s);
        if (announced->grabs) edit_scene(app, GrabEdit{announced->molecule});
    } else if (frame_of(app).readout.refused_edits == announced->refused_edits) {
        return;  // a refusal is said by the readout
    }
    app.write<PendingEdits>().announced.reset();
}

std::string molecule_in_hand(const World& app) {
    const AtomRange& held = led_hand(app).held;
    return held.count > 0 ? address_of(*frame_of(app).atoms, held.first, AtomScope::Molecule)
                          : std::string();
}

}  // namespace palpa
