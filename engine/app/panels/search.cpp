// The panel "Search": finds every action, with its keys, every panel, and every key of scene files.
#include "app/actions.h"
#include "app/panels.h"
#include "core/text.h"
#include "core/translate.h"
#include "scene/fields.h"
#include "ui/icons.h"
#include "ui/text_field.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

struct SearchState {
    std::string text;
    std::size_t chosen = 0;
    bool wants_focus = true;  // the field takes the keys at the next drawing
    int steps = 0;            // in the list, down
    bool is_entered = false;
};

// A line of the list: an action, a panel, or a key of scene files.
struct Hit {
    const Action* action = nullptr;
    const Panel* panel = nullptr;
    const FieldNote* key = nullptr;
    int rank = 0;  // lower is better
};

const std::vector<FieldNote>& scene_keys() {
    static const std::vector<FieldNote> keys = list_fields();
    return keys;
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return result;
}

// 0 if the text begins with what is wanted, 1 if a word does, 2 if it has all the words; else none.
int rank_of(const std::string& text, const std::vector<std::string_view>& words,
            const std::string& wanted) {
    constexpr int none = 9;
    if (text.starts_with(wanted)) return 0;
    if (text.find(" " + wanted) != std::string::npos) return 1;
    const bool has_all = std::ranges::all_of(
        words, [&](std::string_view word) { return text.find(word) != std::string::npos; });
    return has_all ? 2 : none;
}

// The better one of its title and, by two less, of all its words in both languages.
int rank_of(const char* title, const char* explains, const std::vector<std::string_view>& words,
            const std::string& wanted) {
    const int all = rank_of(
        lower(fmt::format("{} {} {} {}", translated(title), translated(explains), title, explains)),
        words, wanted);
    return std::min(rank_of(lower(translated(title)), words, wanted), all + 2);
}

std::vector<Hit> find_hits(const SearchState& state) {
    constexpr std::size_t most = 12;
    constexpr int lowest = 9;
    const std::string wanted = lower(trimmed(state.text));
    const std::vector<std::string_view> words = split_words(wanted);
    std::vector<Hit> hits;
    const auto add = [&](const Hit& hit) {
        if (hit.rank < lowest) hits.push_back(hit);
    };
    for (const Action& action : list_actions())
        add({&action, nullptr, nullptr, rank_of(action.text, action.explains, words, wanted)});
    for (const Panel* const panel : list_panels())
        if (panel->side != Side::Over)
            add({nullptr, panel, nullptr, rank_of(panel->title, panel->explains, words, wanted)});
    if (!wanted.empty())
        for (const FieldNote& key : scene_keys())
            add({nullptr, nullptr, &key,
                 std::min(rank_of(lower(key.key), words, wanted) + 3,
                          rank_of(lower(key.key + " " + key.meaning), words, wanted) + 5)});
    std::ranges::stable_sort(hits, {}, &Hit::rank);
    if (hits.size() > most) hits.resize(most);
    return hits;
}

bool is_possible(const World& app, const Hit& hit) {
    return !hit.action || is_possible(app, *hit.action);
}

void choose_hit(World& app, const Hit& hit) {
    if (!is_possible(app, hit)) return;
    close_panel(app, "search");
    if (hit.action) request(app, *hit.action, By::Search);
    if (hit.panel) open_panel(app, hit.panel->id);
}

// Returns the hit that was clicked on.
const Hit* draw_hits(const World& app, const std::vector<Hit>& hits, std::size_t chosen) {
    const Hit* clicked = nullptr;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const auto& [action, panel, key, rank] = hits[i];
        const std::string title = action  ? translated(action->text)
                                  : panel ? format_translated("Panel {}", translated(panel->title))
                                          : key->key;
        const std::string line = fmt::format("{}##{}", title, i);
        ImGui::BeginDisabled(!is_possible(app, hits[i]));
        if (ImGui::Selectable(line.c_str(), i == chosen)) clicked = &hits[i];
        ImGui::EndDisabled();
        const std::string right = action ? keys_of(*action) : key ? key->fallback : "";
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x -
                        ImGui::CalcTextSize(right.c_str()).x);
        ImGui::TextDisabled("%s", right.c_str());
        if (i != chosen) continue;
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("%s", action ? translated(action->explains)
                                  : panel
                                      ? translated(panel->explains)
                                      : fmt::format("{} ({})", key->meaning, key->type).c_str());
        ImGui::PopTextWrapPos();
    }
    if (hits.empty()) ImGui::TextDisabled("%s", translated("nothing has these words"));
    return clicked;
}

void draw_search(World& app) {
    SearchState& state = panel_state<SearchState>(app);
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float width = std::min(scaled(520), screen.x - 2 * panel_edge());
    ImGui::SetNextWindowPos({0.5F * screen.x, 0.12F * screen.y}, ImGuiCond_Always, {0.5F, 0});
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, 0.75F * screen.y});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::SetNextWindowFocus();
    ImGui::SetNextWindowBgAlpha(1);
    ImGui::Begin("##search", nullptr, fixed_panel | ImGuiWindowFlags_NoTitleBar);
    if (std::exchange(state.wants_focus, false)) ImGui::SetKeyboardFocusHere();
    if (type_text("##wanted", translated("what do you want to do?"), state.text)) state.chosen = 0;
    const std::vector<Hit> hits = find_hits(state);
    if (!hits.empty()) {
        const int last = static_cast<int>(hits.size()) - 1;
        state.chosen = static_cast<std::size_t>(
            std::clamp(static_cast<int>(state.chosen) + std::exchange(state.steps, 0), 0, last));
    }
    const Hit* chosen = draw_hits(app, hits, state.chosen);
    if (std::exchange(state.is_entered, false)) {
        state.wants_focus = true;  // Enter has taken it
        if (!hits.empty() && !state.text.empty()) chosen = &hits[state.chosen];
    }
    if (chosen) choose_hit(app, *chosen);
    ImGui::End();
}

void begin_search(World& app) { panel_state<SearchState>(app) = {}; }

bool press_in_search(World& app, const KeyPress& press) {
    SearchState& state = panel_state<SearchState>(app);
    if (press.key == Key::Escape) close_panel(app, "search");
    if (press.key == Key::Down) ++state.steps;
    if (press.key == Key::Up) --state.steps;
    if (press.key == Key::Enter) state.is_entered = true;
    return !(press.control && press.key == Key::Q);
}

}  // namespace

extern const Panel search_panel{
    .id = "search",
    .title = for_translation("Search"),
    .explains = for_translation("Every action, panel and key of scene files."),
    .icon = icon_search,
    .side = Side::Over,
    .draw = draw_search,
    .is_open = false,
    .take_keys = begin_search,
    .press = press_in_search};

}  // namespace palpa
