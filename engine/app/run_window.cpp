#include "app/run_window.h"

#include "app/device_choice.h"
#include "app/frame.h"
#include "app/live_session.h"
#include "app/notices.h"
#include "app/recorder.h"
#include "app/replay_session.h"
#include "app/window_world.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/translate.h"

#include <fmt/format.h>
#include <cstdio>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace palpa {
namespace {

std::vector<WindowHand> list_window_hands(Device& first, const WindowOptions& options) {
    std::vector<WindowHand> hands{{&first, options.orders, options.mouse_reach_m}};
    if (const LedDevice& second = options.second; second.device)
        hands.push_back({second.device, second.orders, second.mouse_reach_m});
    return hands;
}

std::vector<LiveDevice> list_devices(std::span<const WindowHand> hands) {
    std::vector<LiveDevice> devices;
    for (const WindowHand& hand : hands) devices.push_back({hand.device, hand.orders});
    return devices;
}

// Does what the options ask for at the start.
void begin(World& app) {
    const WindowOptions& options = options_of(app);
    shell_of(app).window().set_title("Palpa - " + scene_of(app).title);
    if (options.sound.is_on) (void)switch_sound(app, true);
    if (options.record) {
        app.write<Recorder>().recorded_in = *options.record;
        session_of(app).begin_recording(*options.record, options.overwrites, options.trajectory);
    }
    if (options.notice.empty()) return;
    const std::string before = app.resource<Notices>().text;
    tell(app, before.empty() ? options.notice : options.notice + "\n" + before, long_notice_s);
}

// Ends and compresses a recording before the window goes, which says so meanwhile.
void close_recording(WindowShell& shell, WindowSession& session) {
    if (!session.recording() && !session.packed_share()) return;
    try {
        const bool is_done = shell.work(
            translated("Compressing the recording. Cancelled, it stays as large as it is."),
            [&](const StageFunction& stage) { finish_recording(session, stage); });
        // A person may leave it as it is; a signal ends the window alone.
        if (!is_done && noted_interrupt() == 0) session.stop_packing();
    } catch (const LoadError& error) {
        fmt::print(stderr, "note: {}\n", error.what());
    }
    finish_recording(session, {});
    for (const EndedRecording& ended : session.take_ended()) {
        if (!ended.problem.empty())
            fmt::print(stderr, "note: {} could not be compressed: {}\n", ended.folder.string(),
                       ended.problem);
    }
}

}  // namespace

WindowReport run_window(WindowShell& shell, const SceneDescription& scene, Device& device,
                        const WindowOptions& options) {
    std::vector<WindowHand> hands = list_window_hands(device, options);
    World app;  // outlives the session, which uses devices that it owns
    std::unique_ptr<WindowSession> session;
    const auto load = [&](const StageFunction& on_stage) {
        if (options.replay) {
            session =
                std::make_unique<ReplaySession>(*options.replay, scene, options.view, on_stage);
        } else {
            auto live =
                std::make_unique<LiveSession>(scene, options.view, list_devices(hands), nullptr,
                                              options.server, options.playback, on_stage);
            if (options.statistics) live->write_statistics(*options.statistics, options.overwrites);
            session = std::move(live);
        }
    };
    WindowReport report;
    if (shell.work(format_translated("Opening {}", scene.title), load)) {
        app = build_window_world({&shell, session.get(), &options, &scene}, std::move(hands));
        begin(app);
        run_frames(app);
        report = report_window(app);
        close_recording(shell, *session);
    } else {
        report.next.emplace();
    }
    shell.check_validation();
    return report;
}

}  // namespace palpa
