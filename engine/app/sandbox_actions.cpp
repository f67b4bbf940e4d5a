// What keys and buttons ask for.
#include "app/sandbox.h"

#include "core/load_error.h"
#include "core/translate.h"
#include "ui/playback_panel.h"
#include "ui/shown_names.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <functional>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

// Of what a study leaves to a person: where to look, and the way out.
bool is_of_picture(Action action) {
    return action == Action::Focus || action == Action::FrameAll || action == Action::FirstView ||
           action == Action::Screenshot || action == Action::RestartGraphics ||
           action == Action::LargerText || action == Action::SmallerText ||
           action == Action::UsualText || action == Action::Quit;
}

std::filesystem::path next_recording(const std::filesystem::path& folder) {
    for (int number = 1;; ++number) {
        std::filesystem::path path = folder / fmt::format("palpa-session-{:04}", number);
        std::error_code error;
        if (!std::filesystem::exists(path, error)) return path;
    }
}

}  // namespace

void Sandbox::give(const Answer& answer) {
    const std::function<void()> then = answer.then;  // the answer goes with its question
    question_.reset();
    if (then) then();
}

// Shows the molecules by the next of the `count` values that `choice` may have; `said`: an English
// format of the notice.
template <typename Value>
void Sandbox::choose_next(Value ViewSettings::* choice, std::size_t count, const char* said) {
    const std::size_t next = (static_cast<std::size_t>(view_.*choice) + 1) % count;
    ViewSettings view = view_;
    view.*choice = static_cast<Value>(next);
    show_as(view);
    notice(fmt::format(fmt::runtime(translated(said)), shown_name(static_cast<Value>(next))));
}

bool Sandbox::save_scene() {
    if (refuse_in_replay() || !options_.save) return false;
    try {
        const std::string file = options_.save(session_.copy_world(), describe_view());
        note_saved();
        notice(format_translated("saved {}", file), first_notice_s);
        return true;
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
        return false;
    }
}

void Sandbox::ask_to_quit() { ask_to_leave("quit", std::nullopt); }

// `next`: what is shown then; `how`: "quit".
void Sandbox::ask_to_leave(const std::string& how, std::optional<NextScreen> next) {
    if (options_.study && next) return;
    const auto leave = [this, next = std::move(next)] {
        next_ = next;
        quitting_ = true;
    };
    if (options_.study || !options_.save || is_saved()) return leave();
    question_ = {
        translated("Your changes are not saved."),
        {{Key::S,
          how == "quit" ? translated("Save and quit (S)") : translated("Save and go on (S)"),
          [this, leave] {
              if (save_scene()) leave();
          }},
         {Key::Q,
          how == "quit" ? translated("Quit without saving (Q)")
                        : translated("Go on without saving (Q)"),
          leave},
         {Key::Escape, translated("Stay (Esc)")}}};
}

// On standard error too, where it stays.
void Sandbox::tell_recording_notes() {
    for (const std::string& note : session_.take_recording_notes()) {
        fmt::print(stderr, "note: {}\n", note);
        notice(note, first_notice_s);
    }
}

void Sandbox::record_or_end() {
    try {
        if (session_.recorded_s()) {
            session_.end_recording();
            tell_recording_notes();
            notice(format_translated("recorded into {0}; to play it: Ctrl+O, O, its journal.txt",
                                     recorded_in_.string()),
                   first_notice_s);
        } else {
            recorded_in_ = next_recording(options_.screenshots);
            session_.begin_recording(recorded_in_, false, options_.trajectory);
            notice(format_translated("recording into {}", recorded_in_.string()));
        }
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
    }
}

void Sandbox::press_study_key() {
    StudyCourse& study = *options_.study;
    if (study.stage() == StudyCourse::Stage::Done) quitting_ = true;
    const std::size_t before = study.results().size();
    if (study.press_key()) {
        LiveSettings settings = overlay_.settings();
        settings.coupling.mode = study.mode();
        session_.send(settings);
        // The mouse's hand stays where the handle is.
        rest_all();
        session_.send(Reset{study.start_angstrom()});
    }
    if (study.results().size() > before && options_.on_trial) options_.on_trial();
}

void Sandbox::perform(Action action) {
    if (options_.study && !is_of_picture(action)) return;
    if (action == Action::Reset) show_first_view();
    if (action == Action::Reset) rest_all();
    if (action == Action::Reset) wanted_.reset();
    if (action == Action::Reset) announced_.reset();
    if (action == Action::Reset) lesson_step_.reset();  // its step has a view of its own
    std::vector<Command> commands;
    if (overlay_.perform(action, commands)) {
        for (const Command& command : commands) session_.send(command);
        return;
    }
    switch (action) {
        case Action::Undo:
            undo_or_redo(true);
            break;
        case Action::Redo:
            undo_or_redo(false);
            break;
        case Action::NextRepresentation:
            choose_next(&ViewSettings::representation, representation_names.size(),
                        for_translation("shown as {}"));
            break;
        case Action::NextColouring:
            choose_next(&ViewSettings::colouring, colouring_names.size(),
                        for_translation("coloured by {}"));
            break;
        case Action::OtherHand:
            exchange_hands();
            break;
        case Action::Record:
            record_or_end();
            break;
        case Action::Add:
            open_add_panel();
            break;
        case Action::Remove:
            remove_held();
            break;
        case Action::Release:
            release();
            break;
        case Action::PutBack:
            put_back();
            break;
        case Action::Focus:
            look_at_grabbed_or_all();
            break;
        case Action::FrameAll:
            look_at_all();
            break;
        case Action::FirstView:
            show_first_view();
            break;
        case Action::StartScreen:
            ask_to_leave("go on", NextScreen{});
            break;
        case Action::Select:
            open_selection();
            break;
        case Action::FocusSelected:
            look_at_selected_or_ligand();
            break;
        case Action::NextView:
            go_to_next_view();
            break;
        case Action::AddView:
            add_view();
            break;
        case Action::Tour:
            begin_or_end_tour();
            break;
        case Action::NextDevice:
            choose_next_device();
            break;
        case Action::ToggleSound:
            choose_sound();
            break;
        case Action::Screenshot:
            wants_shot_ = true;
            break;
        case Action::Film:
            film_or_end();
            break;
        case Action::Export:
            ask_for_export();
            break;
        case Action::PlayTrajectory:
            if (frame_.readout.playback) session_.send(play_or_pause(*frame_.readout.playback));
            break;
        case Action::TrajectoryStart:
            if (frame_.readout.playback) session_.send(play_from_start());
            break;
        case Action::RestartGraphics:
            shell_.restart_graphics();
            break;
        case Action::Save:
            (void)save_scene();
            break;
        case Action::LargerText:
            notice(shell_.change_text_scale(shell_.text_scale() * text_step));
            break;
        case Action::SmallerText:
            notice(shell_.change_text_scale(shell_.text_scale() / text_step));
            break;
        case Action::UsualText:
            notice(shell_.change_text_scale(1));
            break;
        case Action::Quit:
            if (options_.study || (!overlay_.close_something() && !end_tour() && !end_selection()))
                ask_to_quit();
            break;
        default:
            break;
    }
}

}  // namespace palpa
