#include "app/saving.h"

#include "app/camera.h"
#include "app/editing.h"
#include "app/notices.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/load_error.h"
#include "core/translate.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// Edits that a scene file keeps: not what is in hand, nor the coupling, which the settings have.
std::vector<EditAction> list_lasting_edits(const World& app) {
    std::vector<EditAction> actions;
    const auto& edits = frame_of(app).edits;
    if (!edits) return actions;
    for (const EditDescription& edit : *edits)
        if (kind_of(edit.action).is_of_molecules) actions.push_back(edit.action);
    return actions;
}

// Nobody misses the mode, which a key brings back.
bool has_same_settings(const World& app) {
    std::vector<LiveSettings> now = list_hand_settings(app);
    const std::vector<LiveSettings>& written = app.resource<WrittenState>().settings;
    for (std::size_t hand = 0; hand < std::min(now.size(), written.size()); ++hand)
        now[hand].coupling.mode = written[hand].coupling.mode;
    return now == written;
}

}  // namespace

bool is_saved(const World& app) {
    const WrittenState& written = app.resource<WrittenState>();
    return has_same_settings(app) && app.resource<ViewAdditions>() == written.additions &&
           app.resource<SavedViewState>().all == written.views &&
           list_lasting_edits(app) == written.edits;
}

void note_saved(World& app) {
    WrittenState& written = app.write<WrittenState>();
    written.settings = list_hand_settings(app);
    written.additions = app.resource<ViewAdditions>();
    written.views = app.resource<SavedViewState>().all;
    written.edits = list_lasting_edits(app);
}

bool save_scene_in_window(World& app) {
    if (!options_of(app).save) return false;
    if (refuse_in_replay(app)) return false;
    try {
        const std::string file =
            options_of(app).save(session_of(app).copy_world(), describe_view(app));
        note_saved(app);
        tell(app, format_translated("saved {}", file), long_notice_s);
        return true;
    } catch (const LoadError& error) {
        tell(app, error.what(), long_notice_s);
        return false;
    }
}

void save_for_crash(World& app) {
    constexpr std::chrono::seconds between{20};
    WrittenState& written = app.write<WrittenState>();
    if (!options_of(app).save_for_crash || !has_frame(app) ||
        SteadyClock::now() < written.next_crash_save)
        return;
    written.next_crash_save = SteadyClock::now() + between;
    if (!is_saved(app))
        options_of(app).save_for_crash(session_of(app).copy_world(), describe_view(app));
}

void ask_to_leave(World& app, std::optional<NextScreen> next) {
    if (is_study(app) && next) return;
    const bool quits = !next;
    const auto leave = [&app, next = std::move(next)] {
        app.write<FrameLoop>().next = next;
        app.write<FrameLoop>().is_quitting = true;
    };
    if (is_study(app) || !options_of(app).save || is_saved(app)) return leave();
    app.write<Dialogs>().question = {
        translated("Your changes are not saved."),
        {{Key::S, quits ? translated("Save and quit (S)") : translated("Save and go on (S)"),
          [&app, leave] {
              if (save_scene_in_window(app)) leave();
          }},
         {Key::Q,
          quits ? translated("Quit without saving (Q)") : translated("Go on without saving (Q)"),
          leave},
         {Key::Escape, translated("Stay (Esc)")}}};
}

void ask_to_quit(World& app) { ask_to_leave(app, std::nullopt); }

void open_start_screen(World& app) { ask_to_leave(app, NextScreen{}); }

}  // namespace palpa
