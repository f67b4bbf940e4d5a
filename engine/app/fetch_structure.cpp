#include "app/fetch_structure.h"

#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "download/pdb_code.h"
#include "ui/colours.h"
#include "ui/layout.h"
#include "ui/text_field.h"

#include <imgui.h>
#include <system_error>
#include <utility>

namespace palpa {

NextScreen name_screen(std::vector<std::filesystem::path> named) {
    NextScreen next;
    for (std::filesystem::path& one : named) {
        std::error_code error;
        const bool may_be_code = next.code.empty() && !std::filesystem::exists(one, error);
        const auto code = may_be_code ? find_pdb_code(one.string()) : std::nullopt;
        if (code) {
            next.code = *code;
        } else {
            next.files.push_back(std::move(one));
        }
    }
    return next;
}

EntrySource find_entry_source(const PreferencesFile& preferences) {
    if (!preferences.problem().empty())
        throw LoadError({"preferences"}, "cannot be read, and name where to download from: " +
                                             preferences.problem());
    const std::optional<std::filesystem::path> cache = find_cache_folder("structures");
    if (!cache)
        throw LoadError({"cache"}, "there is no folder for downloads (set HOME or XDG_CACHE_HOME)");
    const Preferences& now = preferences.now();
    EntrySource source{.cache = *cache};
    if (now.download_from) source.base = *now.download_from;
    if (now.download_stall_seconds) source.limits.stall_s = *now.download_stall_seconds;
    return source;
}

std::optional<FetchedEntry> fetch_structure(WindowShell& shell, const PreferencesFile& preferences,
                                            const std::string& code) {
    const EntrySource source = find_entry_source(preferences);
    FetchedEntry entry;
    const bool is_done = shell.work(
        format_translated("Downloading {} from {}", upper_case(code), source.base),
        [&](const StageFunction& on_stage) { entry = fetch_entry(code, source, false, on_stage); });
    if (!is_done) return std::nullopt;
    return entry;
}

std::string translated_description(const FetchedEntry& entry) {
    const double megabytes = static_cast<double>(entry.bytes) / 1e6;
    if (entry.is_from_cache)
        return format_translated("Taken from the cache: {} ({:.2f} MB).", entry.file.string(),
                                 megabytes);
    return format_translated("Downloaded from {} ({:.2f} MB) to {}.", entry.address, megabytes,
                             entry.file.string());
}

std::optional<std::string> CodeField::draw() {
    bool is_asked = std::exchange(is_entered_, false);
    if (ImGui::BeginTable("##code", 2)) {
        ImGui::TableSetupColumn("##text", ImGuiTableColumnFlags_WidthStretch);
        ImGui::TableSetupColumn("##button", ImGuiTableColumnFlags_WidthFixed);
        ImGui::TableNextColumn();
        if (wants_focus_) ImGui::SetKeyboardFocusHere();
        wants_focus_ = false;
        (void)type_text("##typed", translated("PDB code (P)"), typed_,
                        ImGuiInputTextFlags_AutoSelectAll);
        ImGui::TableNextColumn();
        is_asked = ImGui::Button(labelled("Get").c_str()) || is_asked;
        tip(
            translated("Downloads the structure of this code (1HSG) or link from the Protein Data "
                       "Bank, and prepares it"));
        ImGui::EndTable();
    }
    std::optional<std::string> code;
    if (is_asked) code = read(typed_);
    if (!problem_.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, colours().wrong);
        ImGui::TextWrapped("%s", problem_.c_str());
        ImGui::PopStyleColor();
    }
    return code;
}

std::optional<std::string> CodeField::paste() {
    const char* const text = ImGui::GetClipboardText();
    typed_ = text ? text : "";
    return read(typed_);
}

std::optional<std::string> CodeField::read(const std::string& text) {
    std::optional<std::string> code = find_pdb_code(text);
    problem_ = code ? std::string()
                    : format_translated(
                          "'{}' is no PDB code; expected one such as 1HSG, or a link "
                          "to an entry",
                          printable(text));
    return code;
}

}  // namespace palpa
