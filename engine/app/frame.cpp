#include "app/frame.h"

#include "app/camera.h"
#include "app/clean_picture.h"
#include "app/device_choice.h"
#include "app/draw_window.h"
#include "app/editing.h"
#include "app/hands.h"
#include "app/inspected.h"
#include "app/lesson_course.h"
#include "app/marks.h"
#include "app/measure_scene.h"
#include "app/notices.h"
#include "app/panels.h"
#include "app/recorder.h"
#include "app/saved_views.h"
#include "app/saving.h"
#include "app/scene_cards.h"
#include "app/selecting.h"
#include "app/settings.h"
#include "app/take_input.h"
#include "app/window_world.h"
#include "core/load_error.h"
#include "core/machine.h"
#include "core/translate.h"
#include "session/run_headless.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace palpa {
namespace {

// Takes over the newest frame of the session.
void read_frame(World& app) {
    NewestFrame& newest = app.write<NewestFrame>();
    if (!session_of(app).read_frame(newest.frame)) return;
    newest.is_there = true;
    Readout& readout = newest.frame.readout;
    for (WindowHand& hand : app.write<WindowHands>().all)
        hand.statistics.add_step(readout.step_ms * 1e-3, true);
    readout.contact = led_hand(app).contact;
    readout.holds_something = led_hand(app).held.count > 0;
    follow_settings(app);
    tell_news(app);
}

// Keeps the picture that the start screen will show of the scene.
void keep_picture(World& app) {
    const auto& keep = options_of(app).keep_picture;
    if (!keep || !has_frame(app) || !shell_of(app).graphics()) return;
    constexpr CleanPicture small{.width = card_picture_width,
                                 .height = card_picture_height,
                                 .has_words = false,
                                 .has_arrow = false};
    try {
        keep(draw_clean_picture(app, small));
    } catch (const GpuError&) {  // then the card has none
    } catch (const LoadError&) {
    }
}

using FrameSystem = void (*)(World& app);
constexpr FrameSystem frame[] = {
    take_ticks,         // of the servo: statistics, readings, the lesson's step
    read_frame,         // the session's newest picture and readout
    measure_scene,      // period and gains, where they are not known here
    select_anew,        // after molecules were added or removed
    follow_lesson,      // its restart, the view of a new step
    follow_tour,        // the next saved view
    send_view,          // what is to be drawn
    save_for_crash,     // now and then
    tell_of_recording,  // films, recordings, servers
    take_input,         // keys, mouse, devices
    look_for_devices,   // once a second
    play_force,         // as a tone
    draw_window,        // panels, picture, swapchain; then what panels asked for
};

}  // namespace

World build_window_world(const WindowLinks& links, std::vector<WindowHand> hands) {
    const WindowOptions& options = *links.options;
    const SceneDescription& scene = *links.scene;
    World app;
    app.set_resource(links);
    NewestFrame newest;
    for (std::size_t hand = 0; hand < scene.hands.size(); ++hand)  // empty until the first frame
        newest.frame.hands.push_back({.settings = settings_of(scene, hand)});
    app.set_resource(std::move(newest));
    app.set_resource(FrameLoop{});
    app.set_resource(
        WindowHands{.all = std::move(hands), .is_explained = options.is_hand_explained});
    app.set_resource(DeviceChoice{.menu = options.devices});
    app.set_resource(ForceTone{});
    app.set_resource(CameraState{.clips = scene.view.clip});
    app.set_resource(PictureState{.view = options.view, .sent = options.view});
    app.set_resource(begin_measure(scene.measured_on, machine_name()));
    app.set_resource(SavedViewState{.all = scene.view.saved});
    app.set_resource(SelectionState{});
    app.set_resource(Measuring{});
    app.set_resource(additions_of(scene.view));
    app.set_resource(SettingsState{.now = settings_of(scene, 0)});
    app.set_resource(PendingEdits{});
    app.set_resource(Readings{});
    app.set_resource(LessonState{.lesson = Lesson(scene.lesson)});
    app.set_resource(Notices{});
    app.set_resource(Dialogs{.question = {}, .add = AddPanel(scene.file.parent_path())});
    app.set_resource(Recorder{});
    app.set_resource(Pointer{});
    app.set_resource(Inspected{});
    app.set_resource(build_docks(options.panels));
    app.set_resource(WrittenState{});
    update_stiffness_limit(app);
    note_saved(app);
    return app;
}

void run_frames(World& app) {
    WindowShell& shell = shell_of(app);
    const WindowOptions& options = options_of(app);
    shell.run(
        options.most_frames_per_s,
        [&] {
            if (shell.window().should_close()) {
                shell.window().keep_open();
                ask_to_quit(app);
            }
            const SteadyClock::time_point begin = SteadyClock::now();
            for (const FrameSystem system : frame) system(app);
            FrameLoop& loop = app.write<FrameLoop>();
            if (is_minimised(app)) return !loop.is_quitting;
            loop.last_ms = 1e3 * seconds_since(begin);
            app.write<PictureState>().scale.add_frame(loop.last_ms);
            constexpr std::size_t most = 100'000;
            if (loop.frame_ms.size() < most) loop.frame_ms.push_back(loop.last_ms);
            return !loop.is_quitting;
        },
        [&] { tell(app, translated("the graphics device was lost and has been set up again")); });
    shell.window().capture_cursor(false);  // Space may have captured it
    keep_picture(app);
    (void)keep_choice(options.remember_panels, list_docks(app.resource<Docks>()));
}

WindowReport report_window(const World& app) {
    const std::vector<WindowHand>& hands = app.resource<WindowHands>().all;
    const FrameLoop& loop = app.resource<FrameLoop>();
    WindowReport report;
    report.settings = list_hand_settings(app);
    report.frames = loop.frame_ms.size();
    report.render_scale = app.resource<PictureState>().scale.value();
    report.lesson_steps_done = app.resource<LessonState>().lesson.steps_done();
    report.next = loop.next;
    report.replay = frame_of(app).readout.replay;
    report.summary = hands.front().statistics.summary();
    report.summary.device = hands.front().device->spec().name;
    report.summary.unbinding = session_of(app).find_unbinding();
    for (const WindowHand& other : std::span(hands).subspan(1)) {
        report.summary.other_hands.push_back(other.statistics.summary());
        report.summary.other_hands.back().device = other.device->spec().name;
    }
    report.summary.steps = frame_of(app).readout.steps;
    warn_of_outcome(report.summary);
    report.summary.overruns = session_of(app).servo_health().overruns;
    if (!loop.frame_ms.empty()) {
        std::vector<double> ms = loop.frame_ms;
        const auto middle = ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2);
        std::nth_element(ms.begin(), middle, ms.end());
        report.median_frame_ms = *middle;
    }
    return report;
}

}  // namespace palpa
