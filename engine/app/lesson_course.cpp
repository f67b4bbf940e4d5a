#include "app/lesson_course.h"

#include "app/actions.h"
#include "app/panels.h"
#include "app/saved_views.h"
#include "app/saving.h"
#include "app/settings.h"
#include "app/window_shell.h"
#include "app/window_world.h"
#include "view/saved_views.h"

#include <optional>
#include <utility>

namespace palpa {
namespace {

// Ticks from before a reset come until the frame after the one that shows it.
void follow_restart(LessonState& state, const Readout& readout) {
    if (!state.awaited_reset) return;
    if (state.saw_reset) return state.awaited_reset.reset();
    state.saw_reset = readout.resets >= *state.awaited_reset;
}

// The view of a step that has begun, and the panel that it teaches.
void begin_step(World& app) {
    const LessonState& state = app.resource<LessonState>();
    const Lesson& lesson = state.lesson;
    SavedViewState& views = app.write<SavedViewState>();
    if (!app.resource<PictureState>().has_first || !is_panel_open(app, "lesson") || is_study(app))
        return;
    if (lesson.is_done() || views.lesson_step == lesson.current()) return;
    views.lesson_step = lesson.current();
    const LessonStepDescription& step = lesson.steps()[*views.lesson_step];
    if (step.panel != LessonPanel::None)
        bring_forward(app, lesson_panel_names[static_cast<std::size_t>(step.panel)]);
    const std::string& name = step.view;
    const SavedView* const saved = name.empty() ? nullptr : find_saved_view(views.all, name);
    if (saved) go_to_view(app, static_cast<std::size_t>(saved - views.all.data()));
}

}  // namespace

void follow_lesson(World& app) {
    LessonState& state = app.write<LessonState>();
    const bool is_done = state.lesson.steps_done() == state.lesson.steps().size();
    if (is_done && !state.was_skipped && !std::exchange(state.is_noted, true))
        (void)keep_choice(options_of(app).lesson.remember_done, true);
    follow_restart(state, frame_of(app).readout);
    state.measured = frame_of(app).readout.lesson.values;
    begin_step(app);
}

void follow_lesson_by_tick(World& app, const ServoTick& tick) {
    LessonState& state = app.write<LessonState>();
    if (tick.contact.is_still || state.awaited_reset) return;
    const Reading& reading = app.resource<Readings>().last;
    state.lesson.update(reading, app.resource<SettingsState>().now.coupling.mode, state.measured);
    if (!state.lesson.steps().empty())
        state.curve.add(reading, tick.contact.molecule.place_angstrom, tick.contact.grip_number);
}

void restart_lesson(World& app) {
    LessonState& state = app.write<LessonState>();
    state.lesson.restart();
    state.was_skipped = false;
    state.curve.clear();
    set_mode(app, coupling_of(scene_of(app), app.resource<SettingsState>().now.hand).mode);
    state.awaited_reset = frame_of(app).readout.resets + 1;
    state.saw_reset = false;
    action_called("reset").act(app);
}

void go_on_in_lesson(World& app) {
    constexpr double reads_s = 1.5;
    if (!is_panel_seen(app, "lesson")) return;
    LessonState& state = app.write<LessonState>();
    const std::optional<NextLesson>& next = options_of(app).lesson.next;
    if (!state.lesson.is_done()) {
        if (state.lesson.go_on()) state.since = SteadyClock::now();
    } else if (next && seconds_since(state.since) > reads_s) {  // no key that was pressed twice
        ask_to_leave(app, NextScreen{{next->file}});
    }
}

void skip_step(World& app) {
    LessonState& state = app.write<LessonState>();
    state.was_skipped = state.was_skipped || !state.lesson.is_step_done();
    state.lesson.skip();
}

}  // namespace palpa
