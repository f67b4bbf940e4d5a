#include "ui/file_browser.h"

#include "core/files.h"
#include "core/translate.h"
#include "ui/layout.h"
#include "ui/text_field.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_entries = 5000;

std::string in_small_letters(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

fs::path home_folder() {
    for (const char* const name : {"HOME", "USERPROFILE"})
        if (const char* const home = std::getenv(name)) return home;
    return fs::current_path();
}

// Folders that a person knows by name; those that are there.
struct Place {
    const char* name;
    const char* below_home;
};
constexpr std::array places{
    Place{for_translation("Home folder"), ""}, Place{for_translation("Documents"), "Documents"},
    Place{for_translation("Downloads"), "Downloads"}, Place{for_translation("Desktop"), "Desktop"}};

// "512 B", "12 kB", "3.4 MB".
std::string describe_size(std::uintmax_t bytes) {
    constexpr double kilo = 1000;
    if (bytes < 1000) return fmt::format("{} B", bytes);
    if (bytes < 1'000'000) return fmt::format("{:.0f} kB", static_cast<double>(bytes) / kilo);
    return fmt::format("{:.1f} MB", static_cast<double>(bytes) / (kilo * kilo));
}

}  // namespace

std::string FileBrowser::chosen() const {
    return chosen_ < entries_.size() ? entries_[chosen_].name : std::string();
}

void FileBrowser::open(std::string title, std::vector<std::string> endings,
                       const fs::path& folder) {
    title_ = std::move(title);
    endings_ = std::move(endings);
    is_open_ = true;
    ahead_.clear();
    ImGui::GetIO().ClearInputCharacters();  // the letter that opened it
    go_to(folder_.empty() ? folder : folder_);
    if (folder_.empty()) go_to(home_folder());  // the one of the last time is gone
}

void FileBrowser::close() {
    is_open_ = false;
    ImGui::ClearActiveID();
}

void FileBrowser::press(Key key) {
    if (key == Key::Up) --steps_;
    if (key == Key::Down) ++steps_;
    if (key == Key::Enter) wants_enter_ = true;
}

bool FileBrowser::is_wanted(const fs::path& file) const {
    const std::string name = in_small_letters(file.filename().string());
    return shows_all_ || std::ranges::any_of(endings_, [&](const std::string& ending) {
               return name.ends_with(ending) || name.ends_with(ending + ".gz");
           });
}

void FileBrowser::go_to(const fs::path& folder) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(folder, error), error);
    if (!fs::is_directory(whole, error)) {
        problem_ = format_translated("{} is not a readable folder", folder.string());
        return;
    }
    folder_ = whole;
    typed_ = whole.string();
    problem_.clear();
    entries_.clear();
    chosen_ = 0;
    const std::vector<fs::path> paths = list_folder(whole, most_entries);
    is_cut_off_ = paths.size() == most_entries;
    for (const fs::path& path : paths) {
        const std::string name = path.filename().string();
        if (name.starts_with('.')) continue;
        if (fs::is_directory(path, error)) {
            entries_.push_back({name, {}, true});
        } else if (is_wanted(path)) {
            const std::uintmax_t bytes = fs::file_size(path, error);
            entries_.push_back({name, error ? "" : describe_size(bytes), false});
        }
    }
    std::ranges::stable_partition(entries_, &Entry::is_folder);
}

std::optional<fs::path> FileBrowser::choose(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
        go_to(path);
        return std::nullopt;
    }
    if (fs::exists(path, error)) return path;
    problem_ = format_translated("{} does not exist", path.string());
    return std::nullopt;
}

// A relative path is one from the folder that is shown.
fs::path FileBrowser::find_typed() const {
    return typed_.starts_with("~/") ? home_folder() / typed_.substr(2) : folder_ / typed_;
}

void FileBrowser::draw_places() {
    if (ImGui::Button(labelled("Up").c_str())) go_to(folder_.parent_path());
    ImGui::SameLine();
    for (const Place& place : places) {
        const fs::path folder = home_folder() / place.below_home;
        std::error_code error;
        if (!fs::is_directory(folder, error)) continue;
        if (ImGui::Button(labelled(place.name).c_str())) go_to(folder);
        ImGui::SameLine();
    }
    if (ImGui::Checkbox(labelled("all files").c_str(), &shows_all_)) go_to(folder_);
}

// Letters that follow each other within a second are one word.
void FileBrowser::follow_typing(bool types_path) {
    constexpr double pause_s = 1;
    const ImGuiIO& io = ImGui::GetIO();
    if (types_path || io.InputQueueCharacters.empty()) return;
    if (ImGui::GetTime() - typed_at_s_ > pause_s) ahead_.clear();
    typed_at_s_ = ImGui::GetTime();
    for (const ImWchar letter : io.InputQueueCharacters)
        if (letter > ' ' && letter < 127) ahead_ += static_cast<char>(letter);
    if (ahead_.empty()) return;
    const std::string wanted = in_small_letters(ahead_);
    const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
        return in_small_letters(entry.name).starts_with(wanted);
    });
    if (found == entries_.end()) return;
    chosen_ = static_cast<std::size_t>(found - entries_.begin());
    moved_ = true;
}

std::optional<fs::path> FileBrowser::draw_entries() {
    std::optional<fs::path> opened;
    const float line = ImGui::GetTextLineHeightWithSpacing();
    constexpr float most_lines = 14, other_lines = 9;
    const float fits = ImGui::GetIO().DisplaySize.y / line - other_lines;
    if (!entries_.empty()) {
        const auto last = static_cast<std::ptrdiff_t>(entries_.size()) - 1;
        chosen_ = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(chosen_) + steps_, 0, last));
    }
    if (ImGui::BeginListBox("##entries", {-1, std::clamp(fits, 3.0F, most_lines) * line})) {
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            const Entry& entry = entries_[i];
            const std::string text = entry.is_folder ? entry.name + "/" : entry.name;
            if (ImGui::Selectable(text.c_str(), i == chosen_,
                                  ImGuiSelectableFlags_AllowDoubleClick)) {
                chosen_ = i;
                if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) opened = entry.name;
            }
            if (ImGui::IsItemClicked() || steps_ != 0 || moved_) typed_ = folder_.string();
            if (i == chosen_ && (steps_ != 0 || moved_)) ImGui::SetScrollHereY();
            if (entry.size.empty()) continue;
            ImGui::SameLine(ImGui::GetContentRegionMax().x -
                            ImGui::CalcTextSize(entry.size.c_str()).x);
            ImGui::TextDisabled("%s", entry.size.c_str());
        }
        if (is_cut_off_)
            ImGui::TextDisabled("%s", translated("there are more files: type the name above"));
        if (entries_.empty())
            ImGui::TextDisabled("%s", translated("no matching files in this folder"));
        ImGui::EndListBox();
    }
    steps_ = 0;
    moved_ = false;
    return opened;
}

std::optional<fs::path> FileBrowser::draw() {
    if (!is_open_) return std::nullopt;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    draw_shade();
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSize({std::min(scaled(560), screen.x - 2 * panel_edge()), 0});
    ImGui::SetNextWindowBgAlpha(1);
    ImGui::Begin((title_ + "###file-browser").c_str(), &is_open_,
                 fixed_panel | ImGuiWindowFlags_NoCollapse);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    draw_places();
    std::optional<fs::path> wanted;
    if (type_text("##path", translated("a path"), typed_, ImGuiInputTextFlags_EnterReturnsTrue)) {
        wanted = find_typed();
        wants_enter_ = false;
    }
    const bool types = ImGui::IsItemActive(), has_path = typed_ != folder_.string();
    follow_typing(types);
    if (std::optional<fs::path> opened = draw_entries()) wanted = folder_ / *opened;
    const bool may_open = chosen_ < entries_.size() || has_path;
    ImGui::BeginDisabled(!may_open);
    const bool is_asked =
        ImGui::Button(labelled("Open (Enter)").c_str()) || (wants_enter_ && (!types || has_path));
    ImGui::EndDisabled();
    if (is_asked && may_open && !wanted)
        wanted = has_path ? find_typed() : folder_ / entries_[chosen_].name;
    ImGui::SameLine();
    if (ImGui::Button(labelled("Cancel (Esc)").c_str())) is_open_ = false;
    if (!problem_.empty()) ImGui::TextWrapped("%s", problem_.c_str());
    ImGui::End();
    wants_enter_ = false;
    std::optional<fs::path> file;
    if (wanted) file = choose(*wanted);
    if (file || !is_open_) close();
    return file;
}

}  // namespace palpa
