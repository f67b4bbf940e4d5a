#include "ui/add_panel.h"

#include "core/text.h"
#include "core/translate.h"
#include "molecule/residue_kinds.h"
#include "scene/find_scene.h"
#include "ui/colours.h"
#include "ui/layout.h"
#include "ui/text_field.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>
#include <system_error>

namespace palpa {
namespace {

std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    for (char& letter : lower)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return lower;
}

// What a name of a molecule may be made of, and still be typed everywhere.
std::string as_base(std::string_view text) {
    std::string base;
    for (const char letter : in_lower_case(text)) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0;
        base += is_plain ? letter : '_';
    }
    // "w2" once more is "w3".
    while (!base.empty() && std::isdigit(static_cast<unsigned char>(base.back())) != 0)
        base.pop_back();
    return base.empty() ? "m" : base;
}

std::string describe(const std::string& name, std::size_t atoms) {
    const char* const text = translated_plural("{}   ({} atom)", "{}   ({} atoms)", atoms);
    return fmt::format(fmt::runtime(text), name, atoms);
}

bool is_name(const std::string& text) {
    const std::optional<Address> address = find_address(text);
    return address && address->residue.empty();
}

}  // namespace

std::string find_free_name(const AtomDirectory& atoms, const std::string& base) {
    for (int number = 2;; ++number) {
        std::string name = fmt::format("{}{}", base, number);
        if (!find_molecule(atoms, name)) return name;
    }
}

void AddPanel::open() {
    is_open_ = wants_focus_ = true;
    has_own_name_ = wants_add_ = wants_take_ = false;
    list_steps_ = 0;
}

void AddPanel::open(const AtomDirectory& atoms, const std::string& in_hand) {
    open();
    if (origin_ == Origin::Residue && atoms.force_field->residues.empty()) origin_ = Origin::Copy;
    if (!in_hand.empty()) copy_of_ = in_hand;
}

void AddPanel::open(std::span<const std::filesystem::path> files) {
    const bool was_open = is_open_;
    open();
    const bool has_structure = !std::ranges::all_of(files, is_topology);
    // A topology alone goes with the structure that is there.
    if (has_structure || !was_open) structure_.clear(), topology_.clear(), segment_.clear();
    origin_ = Origin::Files;
    for (const std::filesystem::path& file : files) {
        std::string& field = is_topology(file) ? topology_ : structure_;
        if (field.empty()) field = file.string();
    }
}

// Its fields take no keys from then on.
void AddPanel::close() {
    is_open_ = false;
    ImGui::ClearActiveID();
}

void AddPanel::press(const KeyPress& press) {
    if (press.key == Key::Enter) wants_add_ = true, wants_take_ = press.shift;
    if (press.key == Key::Up) --list_steps_;
    if (press.key == Key::Down) ++list_steps_;
}

std::optional<AddEdit> AddPanel::draw(const AtomDirectory& atoms) {
    if (!is_open_) return std::nullopt;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float edge = panel_edge(), width = std::min(scaled(520), screen.x - 2 * edge);
    draw_shade();
    // It stays where it is when its height changes with what is chosen.
    const float top = std::max(edge, std::round(0.5F * (screen.y - scaled(400))));
    ImGui::SetNextWindowPos({screen.x / 2, top}, ImGuiCond_Always, {0.5F, 0});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, screen.y - top - edge});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::SetNextWindowBgAlpha(1);
    ImGui::Begin(labelled("Add a molecule").c_str(), &is_open_,
                 fixed_panel | ImGuiWindowFlags_NoCollapse);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    choose_origin(Origin::Residue, for_translation("a residue of the force field"));
    choose_origin(Origin::Copy, for_translation("a copy of a molecule"));
    choose_origin(Origin::Files, for_translation("from a file"));
    ImGui::Separator();
    if (origin_ == Origin::Residue) choose_residue(atoms);
    if (origin_ == Origin::Copy) choose_copy(atoms);
    if (origin_ == Origin::Files) choose_files();
    name_it(atoms);
    const std::string problem = find_problem(atoms);
    ImGui::BeginDisabled(!problem.empty());
    takes_ = wants_take_;
    bool is_asked = ImGui::Button(labelled("Add (Enter)").c_str()) || wants_add_;
    ImGui::SameLine();
    if (ImGui::Button(labelled("Add and take (Shift+Enter)").c_str())) is_asked = takes_ = true;
    tip(translated("in hand at once, to be put where it belongs: hold Space and move the mouse"));
    ImGui::EndDisabled();
    ImGui::SameLine();
    const bool is_done = ImGui::Button(labelled("Close (Esc)").c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, colours().wrong);
    ImGui::TextWrapped("%s", problem.empty() ? " " : problem.c_str());
    ImGui::PopStyleColor();
    ImGui::End();
    wants_add_ = wants_take_ = wants_focus_ = false;
    list_steps_ = 0;
    const bool adds = is_asked && problem.empty();
    if (adds || is_done || !is_open_) close();
    return adds ? std::optional(build_edit()) : std::nullopt;
}

void AddPanel::choose_origin(Origin origin, const char* text) {
    if (!ImGui::RadioButton(labelled(text).c_str(), origin_ == origin)) return;
    origin_ = origin;
    has_own_name_ = false;
    wants_focus_ = true;
}

// `texts`: how the names are shown.
void AddPanel::choose_from(std::span<const std::string> names, std::string& chosen,
                           std::span<const std::string> texts) {
    constexpr float most_lines = 7, least_lines = 3, other_lines = 14;
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const float fits = (ImGui::GetIO().DisplaySize.y - 2 * panel_edge()) / line - other_lines;
    const auto found = std::ranges::find(names, chosen);
    auto index = found == names.end() ? 0 : found - names.begin();
    index += list_steps_;
    if (!names.empty()) {
        index = std::clamp<std::ptrdiff_t>(index, 0, std::ssize(names) - 1);
        chosen = names[static_cast<std::size_t>(index)];
    }
    if (!ImGui::BeginListBox("##choice", {-1, std::clamp(fits, least_lines, most_lines) * line}))
        return;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool is_chosen = names[i] == chosen;
        if (ImGui::Selectable(texts[i].c_str(), is_chosen)) chosen = names[i];
        if (is_chosen && (list_steps_ != 0 || wants_focus_)) ImGui::SetScrollHereY();
    }
    ImGui::EndListBox();
}

void AddPanel::choose_residue(const AtomDirectory& atoms) {
    if (wants_focus_) ImGui::SetKeyboardFocusHere();
    const bool is_new_search = type_text("##search", translated("search by name"), search_);
    const std::string wanted = in_lower_case(trimmed(search_));
    std::vector<std::string> names, texts;
    for (const auto& [name, residue] : atoms.force_field->residues) {
        if (residue.atoms.empty() || in_lower_case(name).find(wanted) == std::string::npos)
            continue;
        const std::size_t count = residue.atoms.size();
        names.push_back(name);
        texts.push_back(describe(name, count));
    }
    // What a person typed in full is meant, wherever else it occurs.
    const auto same = std::ranges::find(names, wanted, in_lower_case);
    if (is_new_search) residue_ = same == names.end() ? "" : *same;
    if (names.empty()) residue_.clear();
    choose_from(names, residue_, texts);
}

void AddPanel::choose_copy(const AtomDirectory& atoms) {
    std::vector<std::string> names, texts;
    for (const AtomDirectory::Entry& entry : atoms.molecules) {
        names.push_back(entry.molecule);
        texts.push_back(describe(entry.molecule, entry.atoms.count));
    }
    choose_from(names, copy_of_, texts);
}

void AddPanel::choose_files() {
    ImGui::TextUnformatted(translated("structure: .crd, .pdb or .cif"));
    if (wants_focus_) ImGui::SetKeyboardFocusHere();
    (void)type_text("##structure", translated("a path, or drop a file on the window"), structure_);
    ImGui::TextUnformatted(translated("types and charges: .psf"));
    (void)type_text("##topology", translated("empty: use the force field's residues"), topology_);
    ImGui::TextUnformatted(translated("segment or chain"));
    (void)type_text("##segment", translated("needed only if the file has several"), segment_);
}

void AddPanel::name_it(const AtomDirectory& atoms) {
    ImGui::TextUnformatted(translated("name of the new molecule"));
    if (!has_own_name_) name_ = find_free_name(atoms, find_base());
    (void)type_text("##name", translated("a name"), name_);
    // Under way the text is the library's, so that nobody else may change it.
    if (ImGui::IsItemActive()) has_own_name_ = true;
}

std::string AddPanel::find_base() const {
    switch (origin_) {
        case Origin::Residue:
            return is_water(residue_) ? "w" : as_base(residue_);
        case Origin::Copy:
            return as_base(copy_of_);
        case Origin::Files:
            break;
    }
    return as_base(std::filesystem::path(structure_).stem().string());
}

std::filesystem::path AddPanel::path_of(const std::string& file) const {
    return trimmed(file).empty() ? std::filesystem::path() : folder_ / trimmed(file);
}

std::string AddPanel::find_problem(const AtomDirectory& atoms) const {
    if (origin_ == Origin::Residue && residue_.empty())
        return atoms.force_field->residues.empty()
                   ? translated("the scene's force field has no residues")
                   : translated("no residue of the scene's force field has this name");
    if (origin_ == Origin::Copy && !find_molecule(atoms, copy_of_))
        return translated("choose a molecule");
    if (origin_ == Origin::Files) {
        if (path_of(structure_).empty()) return translated("enter the name of a structure file");
        for (const std::string& file : {structure_, topology_}) {
            std::error_code error;
            const std::filesystem::path path = path_of(file);
            if (!path.empty() && !std::filesystem::is_regular_file(path, error))
                return format_translated("there is no file {}", printable(path.string()));
        }
    }
    const std::string name(trimmed(name_));
    if (name.empty()) return translated("enter a name for the molecule");
    if (!is_name(name)) return translated("a name cannot contain ':'");
    if (find_molecule(atoms, name))
        return format_translated("there is already a molecule {}; enter another name", name);
    return {};
}

AddEdit AddPanel::build_edit() const {
    AddEdit edit;
    edit.name = trimmed(name_);
    if (origin_ == Origin::Residue) edit.residue = residue_;
    if (origin_ == Origin::Copy) edit.copy_of = copy_of_;
    if (origin_ == Origin::Files) {
        edit.structure = path_of(structure_);
        edit.topology = path_of(topology_);
        edit.segment = trimmed(segment_);
    }
    return edit;
}

}  // namespace palpa
