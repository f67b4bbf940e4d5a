// The panel "Inspector": the components of what is looked at, a molecule, a hand, a spring or a
// mark, to be changed.
#include "app/editing.h"
#include "app/hands.h"
#include "app/inspected.h"
#include "app/panels.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/choose.h"
#include "ui/icons.h"
#include "ui/readings.h"
#include "ui/shown_names.h"
#include "ui/text_field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpa {
namespace {

constexpr std::array<const char*, motion_names.size()> motion_texts{
    for_translation("fixed"),
    for_translation("along x"),
    for_translation("moved by a hand"),
    for_translation("moved by a hand, turns"),
    for_translation("free"),
    for_translation("moved and turned by a hand")};
constexpr std::array<const char*, shape_names.size()> shape_texts{for_translation("rigid"),
                                                                  for_translation("flexible")};

void begin_row(const char* name, const char* explanation) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name);
    tip(explanation);
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1);
}

// The text in the field of a molecule's name.
struct NameField {
    std::string of, text;
};

void edit_name(World& app, const SceneMolecule& molecule) {
    NameField& field = panel_state<NameField>(app);
    if (field.of != molecule.name) field = {molecule.name, molecule.name};
    if (std::exchange(app.write<Inspected>().begins_name, false)) ImGui::SetKeyboardFocusHere();
    begin_row(translated("name"), translated("Enter renames the molecule"));
    const bool is_done = type_text("##name", "", field.text, ImGuiInputTextFlags_EnterReturnsTrue);
    if (!is_done && !ImGui::IsItemDeactivated()) return;
    if (is_done && !field.text.empty() && field.text != molecule.name)
        request(app, [edit = RenameEdit{molecule.name, field.text}](World& later) {
            later.write<Inspected>().what = InspectedMolecule{edit.to};
            edit_scene(later, edit);
        });
    field.of.clear();  // or it would keep what was not taken
}

void choose_mobility(World& app, const SceneMolecule& molecule) {
    begin_row(translated("motion"), translated("How the molecule may move as a whole"));
    const Motion now = molecule.mobility.motion;
    const auto motion_name = [](Motion motion) {
        return translated(motion_texts[static_cast<std::size_t>(motion)]);
    };
    if (ImGui::BeginCombo("##motion", motion_name(now))) {  // the others are a hand's
        for (const Motion motion : {Motion::Fixed, Motion::Free})
            if (ImGui::Selectable(motion_name(motion), motion == now) && motion != now)
                request_edit(app, MobilityEdit{molecule.name, motion, {}});
        ImGui::EndCombo();
    }
    begin_row(translated("shape"), translated("Whether its joints may turn"));
    Shape shape = molecule.mobility.shape;
    const auto shape_name = [](Shape each) {
        return translated(shape_texts[static_cast<std::size_t>(each)]);
    };
    if (choose("##shape", shape_names.size(), shape, shape_name))
        request_edit(app, MobilityEdit{molecule.name, {}, shape});
}

void choose_appearance(World& app, const SceneMolecule& molecule) {
    const Appearance& look = molecule.appearance;
    Appearance changed = look;
    const PictureState& picture = app.resource<PictureState>();
    Representation representation = look.representation.value_or(picture.view.representation);
    Colouring colouring = look.colouring.value_or(picture.view.colouring);
    begin_row(translated("drawn as"), translated("Its representation, in place of the scene's"));
    if (choose("##representation", representation_names.size(), representation,
               [](Representation each) { return shown_name(each); }))
        changed.representation = representation;
    begin_row(translated("coloured by"), translated("Its colours, in place of the scene's"));
    if (choose("##colours", colouring_names.size(), colouring,
               [](Colouring each) { return shown_name(each); }))
        changed.colouring = colouring;
    begin_row(translated("shown"), translated("Whether the molecule is drawn"));
    ImGui::Checkbox("##shown", &changed.visible);
    if (changed.representation == look.representation && changed.colouring == look.colouring &&
        changed.visible == look.visible)
        return;
    request_edit(app, AppearanceEdit{molecule.name, changed.representation, changed.colouring,
                                     changed.visible});
}

void draw(World& app, const InspectedMolecule& inspected) {
    const std::vector<SceneMolecule>& molecules = frame_of(app).objects.molecules;
    const auto molecule = std::ranges::find(molecules, inspected.name, &SceneMolecule::name);
    if (molecule == molecules.end())
        return ImGui::TextWrapped("%s", translated("Click on something in the list at the left to "
                                                   "see and change what it is."));
    if (begin_readings("molecule")) {
        edit_name(app, *molecule);
        add_reading(translated("atoms"), fmt::format("{}", molecule->atoms),
                    translated("Their number"));
        add_reading(translated("mass"), fmt::format("{:.2f} amu", molecule->mass),
                    translated("The sum over its atoms"));
        add_reading(translated("charge"), fmt::format("{:+.2f} e", molecule->charge + 0.0),
                    translated("The sum over its atoms"));
        choose_mobility(app, *molecule);
        choose_appearance(app, *molecule);
        ImGui::EndTable();
    }
    if (ImGui::Button(labelled("Take in hand").c_str()))
        request_edit(app, GrabEdit{molecule->name});
    same_line_if_it_fits(translated("Remove"));
    if (ImGui::Button(labelled("Remove").c_str())) request_edit(app, RemoveEdit{molecule->name});
}

void draw(World& app, const InspectedHand& inspected) {
    const std::size_t number = inspected.number;
    const LiveHand& hand = frame_of(app).hands[number];
    const WindowHands& hands = app.resource<WindowHands>();
    const bool has_device = number < hands.all.size();
    if (begin_readings("hand")) {
        add_reading(translated("hand"), name_of_hand(number), translated("Its place in the scene"));
        add_reading(translated("holds"),
                    hand.held_address.empty() ? translated("nothing") : hand.held_address,
                    translated("A molecule as a whole, or a part of it by a spring"));
        if (has_device) {
            add_reading(translated("device"), hands.all[number].device->spec().name,
                        translated("The device that moves it and has its force"));
            add_reading(translated("force"), fmt::format("{:.3f} N", hands.all[number].felt_newton),
                        translated("As sent to the device"));
        }
        ImGui::EndTable();
    }
    ImGui::BeginDisabled(hand.held_address.empty());
    const auto button = [&](const char* text, const EditAction& action) {
        if (ImGui::Button(labelled(text).c_str()))
            request(app, [=](World& later) { edit_scene(later, action, number); });
    };
    button(for_translation("Release"), ReleaseEdit{});
    same_line_if_it_fits(translated("Put back"));
    button(for_translation("Put back"), PutBackEdit{});
    ImGui::EndDisabled();
    if (!has_device || number == hands.led) return;
    if (ImGui::Button(labelled("Lead it by the mouse").c_str()))
        request(app, action_called("other-hand"));
}

// A field for a number within limits, with its unit; true if Enter has changed it.
bool type_number(const char* id, const char* unit, double least, double most, double& value) {
    const double before = value;
    ImGui::SetNextItemWidth(-1);
    const bool is_done = ImGui::InputDouble(id, &value, 0, 0, fmt::format("%.4g {}", unit).c_str(),
                                            ImGuiInputTextFlags_EnterReturnsTrue);
    value = std::isfinite(value) ? std::clamp(value, least, most) : before;
    return is_done && value != before;
}

void draw(World& app, const InspectedSpring& inspected) {
    const std::vector<RestraintEdit>& springs = frame_of(app).objects.restraints;
    const RestraintEdit& spring =
        *std::ranges::find(springs, inspected.atoms, &RestraintEdit::atoms);
    RestraintEdit changed = spring;
    if (begin_readings("spring")) {
        add_reading(translated("spring"), fmt::format("{}", fmt::join(spring.atoms, " - ")),
                    translated("The atoms or residues at its ends"));
        begin_row(translated("stiffness"), translated("k of E = k x²/2; Enter sets it"));
        if (type_number("##k", "kcal/mol/Å²", RestraintEdit::least_k, RestraintEdit::most_k,
                        changed.k_kcal_per_mol_angstrom2))
            request_edit(app, changed);
        begin_row(translated("length"), translated("Its length without force; Enter sets it"));
        if (type_number("##length", "Å", 0, RestraintEdit::most_length, changed.length_angstrom))
            request_edit(app, changed);
        if (changed.place_angstrom) {
            begin_row(translated("to"), translated("The place to which it pulls; Enter sets it"));
            bool is_moved = false;
            for (const std::size_t axis : {0, 1, 2})
                is_moved = type_number(fmt::format("##{}", axis).c_str(), "Å", -farthest_angstrom,
                                       farthest_angstrom, (*changed.place_angstrom)[axis]) ||
                           is_moved;
            if (is_moved) request_edit(app, changed);
        }
        ImGui::EndTable();
    }
    if (!ImGui::Button(labelled("Remove").c_str())) return;
    changed.k_kcal_per_mol_angstrom2 = 0;
    request_edit(app, changed);
}

void draw(World& app, const InspectedMark& inspected) {
    const PinEdit mark{inspected.atoms};
    const std::vector<SceneMark>& marks = frame_of(app).objects.marks;
    const auto found = std::ranges::find(marks, mark, &SceneMark::atoms);
    if (begin_readings("mark")) {
        add_reading(translated("mark"), fmt::format("{}", fmt::join(mark.atoms, " - ")),
                    translated("Two atoms: distance; three: angle; four: dihedral"));
        if (const std::string value = describe_value(*found); !value.empty())
            add_reading(translated("now"), value, translated("After the last step"));
        ImGui::EndTable();
    }
    if (ImGui::Button(labelled("Remove").c_str())) request_edit(app, mark);
}

void draw_inspector(World& app) {
    ImGui::BeginDisabled(is_replay(app));
    std::visit([&](const auto& what) { draw(app, what); }, find_inspected(app));
    ImGui::EndDisabled();
}

}  // namespace

extern const Panel inspector_panel{
    .id = "inspector",
    .title = for_translation("Inspector"),
    .explains =
        for_translation("What the chosen molecule, hand, spring or mark is, to be changed."),
    .icon = icon_info,
    .side = Side::Right,
    .draw = draw_inspector};

}  // namespace palpa
