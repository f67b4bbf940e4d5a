// The panel "Scene": the molecules with eye, lock and hand, the hands, springs, marks, and what a
// person added to the picture.
#include "app/editing.h"
#include "app/hands.h"
#include "app/inspected.h"
#include "app/panels.h"
#include "app/selecting.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/icons.h"
#include "ui/shown_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace palpa {
namespace {

// An icon at the right end of the line, this many icons from it; true if it is pressed.
bool icon_at_end(const char* icon, const char* id, const char* explanation, int from_end = 0) {
    const float padding = ImGui::GetStyle().FramePadding.x;
    const float width = ImGui::CalcTextSize(icon_eye).x + 2 * padding;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - (from_end + 1) * width);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {padding, 0});
    const bool is_pressed = icon_button(icon, id, {width, 0});
    ImGui::PopStyleVar();
    tip(explanation);
    return is_pressed;
}

// A line that shows in the inspector what it names; `now`: what that shows already.
void draw_line(World& app, const std::string& label, const Inspectable& what,
               const Inspectable& now) {
    if (ImGui::Selectable(label.c_str(), what == now, ImGuiSelectableFlags_AllowItemOverlap))
        request(app, [what](World& later) { inspect(later, what); });
}

void set_appearance(World& app, const std::string& molecule, const Appearance& look) {
    request_edit(app, AppearanceEdit{molecule, look.representation, look.colouring, look.visible});
}

// A menu of all values of an enumeration, of which `now` is checked.
template <class Choice>
void choose_in_menu(const char* title, std::size_t count, std::optional<Choice>& now,
                    bool& is_changed) {
    if (!ImGui::BeginMenu(translated(title))) return;
    for (std::size_t i = 0; i < count; ++i) {
        const auto each = static_cast<Choice>(i);
        if (!ImGui::MenuItem(shown_name(each), nullptr, now == each)) continue;
        now = each;
        is_changed = true;
    }
    ImGui::EndMenu();
}

void draw_molecule_menu(World& app, const SceneMolecule& molecule) {
    if (!ImGui::BeginPopupContextItem("menu")) return;
    const std::string& name = molecule.name;
    if (ImGui::MenuItem(translated("Take in hand"))) request_edit(app, GrabEdit{name});
    if (ImGui::MenuItem(translated("Select its atoms")))
        request(app, [name](World& later) {
            select_atoms_by(later, fmt::format("molecule \"{}\"", name));
        });
    Appearance look = molecule.appearance;
    bool is_changed = false;
    choose_in_menu(for_translation("Representation"), representation_names.size(),
                   look.representation, is_changed);
    choose_in_menu(for_translation("Colours"), colouring_names.size(), look.colouring, is_changed);
    if (is_changed) set_appearance(app, name, look);
    if (ImGui::MenuItem(translated("Rename...")))
        request(app, [name](World& later) {
            inspect(later, InspectedMolecule{name});
            later.write<Inspected>().begins_name = true;
        });
    if (ImGui::MenuItem(translated("Remove"))) request_edit(app, RemoveEdit{name});
    ImGui::EndPopup();
}

void draw_lock(World& app, const SceneMolecule& molecule) {
    const bool is_locked = molecule.mobility.motion == Motion::Fixed;
    if (!icon_at_end(is_locked ? icon_lock : icon_unlock, "lock",
                     is_locked ? translated("fixed in place; a click lets it move")
                               : translated("may move; a click fixes it in place"),
                     1))
        return;
    request_edit(app, MobilityEdit{molecule.name, is_locked ? Motion::Free : Motion::Fixed, {}});
}

// The molecules in hands.
std::vector<std::string> list_held(const World& app) {
    std::vector<std::string> held;
    for (const LiveHand& hand : frame_of(app).hands)
        if (hand.held.count > 0)
            held.push_back(address_of(*frame_of(app).atoms, hand.held.first, AtomScope::Molecule));
    return held;
}

void draw_molecules(World& app, const Inspectable& now) {
    const std::vector<std::string> held = list_held(app);
    for (const SceneMolecule& molecule : frame_of(app).objects.molecules) {
        ImGui::PushID(molecule.name.c_str());
        const bool is_held = std::ranges::find(held, molecule.name) != held.end();
        draw_line(app,
                  fmt::format("{}{}", is_held ? fmt::format("{} ", icon_hand) : "", molecule.name),
                  InspectedMolecule{molecule.name}, now);
        draw_molecule_menu(app, molecule);
        tip(format_translated("{} atoms; click shows what it is, right click has more",
                              molecule.atoms)
                .c_str());
        if (!is_held) draw_lock(app, molecule);
        Appearance look = molecule.appearance;
        if (icon_at_end(look.visible ? icon_eye : icon_hidden, "eye",
                        translated("shows or hides the molecule"))) {
            look.visible = !look.visible;
            set_appearance(app, molecule.name, look);
        }
        ImGui::PopID();
    }
}

// A header with a number, folded at first if there are many.
bool begin_group(const char* title, std::size_t count) {
    constexpr std::size_t many = 6;
    if (count == 0) return false;
    const std::string text = fmt::format("{} ({})###{}", translated(title), count, title);
    return ImGui::CollapsingHeader(text.c_str(), count < many ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void draw_hands(World& app, const Inspectable& now) {
    const std::vector<LiveHand>& hands = frame_of(app).hands;
    if (!begin_group(for_translation("Hands"), hands.size())) return;
    for (std::size_t i = 0; i < hands.size(); ++i) {
        const std::string& held = hands[i].held_address;
        draw_line(app,
                  fmt::format("{}: {}###hand {}", name_of_hand(i),
                              held.empty() ? translated("empty") : held, i),
                  InspectedHand{i}, now);
    }
}

void draw_springs_and_marks(World& app, const Inspectable& now) {
    const std::vector<RestraintEdit>& springs = frame_of(app).objects.restraints;
    const std::vector<SceneMark>& marks = frame_of(app).objects.marks;
    if (begin_group(for_translation("Springs"), springs.size()))
        for (std::size_t i = 0; i < springs.size(); ++i) {
            draw_line(app, fmt::format("{}###spring {}", fmt::join(springs[i].atoms, " - "), i),
                      InspectedSpring{springs[i].atoms}, now);
            tip(format_translated("a spring of {:.3g} kcal/mol/Å²",
                                  springs[i].k_kcal_per_mol_angstrom2)
                    .c_str());
        }
    if (begin_group(for_translation("Marks"), marks.size()))
        for (std::size_t i = 0; i < marks.size(); ++i) {
            const std::vector<std::string>& atoms = marks[i].atoms.atoms;
            if (atoms.empty()) continue;  // it has no address
            draw_line(app,
                      fmt::format("{} {}###mark {}", fmt::join(atoms, " - "),
                                  describe_value(marks[i]), i),
                      InspectedMark{atoms}, now);
        }
}

// Lists what a person added to the picture, each with a button to remove it.
void draw_additions(World& app) {
    ViewAdditions changed = app.resource<ViewAdditions>();
    if (changed == ViewAdditions()) return;
    if (!begin_group(for_translation("In the picture"),
                     changed.layers.size() + changed.hidden.size() + changed.labels.size() +
                         changed.measures.size()))
        return;
    const auto list = [&](auto& items, const auto& describe) {
        for (std::size_t i = 0; i < items.size(); ++i) {
            ImGui::PushID(describe(items[i]).c_str());
            const bool is_removed = icon_button(icon_remove, "remove");
            tip(translated("removes it from the picture"));
            ImGui::SameLine();
            ImGui::TextUnformatted(describe(items[i]).c_str());
            ImGui::PopID();
            if (!is_removed) continue;
            items.erase(items.begin() + static_cast<std::ptrdiff_t>(i));
            break;  // one a frame
        }
    };
    list(changed.layers, [](const ViewLayer& layer) {
        return format_translated("{} of {}", shown_name(layer.representation),
                                 layer.of.empty() ? translated("all") : layer.of);
    });
    list(changed.hidden,
         [](const std::string& text) { return format_translated("hidden: {}", text); });
    list(changed.labels,
         [](const std::string& text) { return format_translated("label: {}", text); });
    list(changed.measures,
         [](const std::string& text) { return format_translated("measure: {}", text); });
    set_additions(app, std::move(changed));
}

void draw_tree(World& app) {
    const Inspectable now = find_inspected(app);
    draw_molecules(app, now);
    draw_hands(app, now);
    draw_springs_and_marks(app, now);
    draw_additions(app);
}

}  // namespace

extern const Panel tree_panel{
    .id = "tree",
    .title = for_translation("Scene"),
    .explains = for_translation("Molecules, hands, springs and marks, with eye and lock."),
    .icon = icon_tree,
    .side = Side::Left,
    .draw = draw_tree};

}  // namespace palpa
