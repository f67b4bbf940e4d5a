#include "app/run_window.h"

#include "app/live_session.h"
#include "app/replay_session.h"
#include "app/sandbox.h"
#include "app/screenshots.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "render/picture.h"
#include "session/run_headless.h"
#include "ui/caption.h"
#include "ui/study_panel.h"
#include "ui/view_labels.h"
#include "view/build_frame.h"
#include "view/clip.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

// Stretches the renderer's picture over an image of the window.
void blit(VkCommandBuffer commands, VkImage from, VkExtent2D from_size, VkImage to,
          VkExtent2D to_size) {
    const auto corner = [](VkExtent2D size) {
        return VkOffset3D{static_cast<std::int32_t>(size.width),
                          static_cast<std::int32_t>(size.height), 1};
    };
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = corner(from_size);
    region.dstOffsets[1] = corner(to_size);
    const bool same = from_size.width == to_size.width && from_size.height == to_size.height;
    vkCmdBlitImage(commands, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                   same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

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

}  // namespace

Sandbox::Sandbox(WindowShell& shell, std::unique_ptr<WindowSession> session,
                 const SceneDescription& scene, Device& device, const WindowOptions& options)
    : options_(options),
      devices_(options.devices),
      hands_(list_window_hands(device, options)),
      shell_(shell),
      window_(shell.window()),
      owned_session_(std::move(session)),
      session_(*owned_session_),
      overlay_(scene),
      title_(scene.title),
      saved_(overlay_.settings()),
      first_(scene.view),
      view_(options.view),
      sent_(options.view),
      clips_(scene.view.clip),
      saved_views_(scene.view.saved),
      written_views_(scene.view.saved),
      written_additions_(overlay_.additions()),
      add_panel_(scene.file.parent_path()) {
    std::error_code error;
    if (!std::filesystem::is_directory(options.screenshots, error)) {
        throw LoadError({options.screenshots.string()},
                        "is not a folder; expected the folder for screenshots");
    }
    frame_.hands.resize(hands_.size());  // until the first frame they are empty
    window_.set_title("Palpa - " + scene.title);
    if (options.sound.is_on) (void)switch_sound(true);
    if (options.record) {
        recorded_in_ = *options.record;
        session_.begin_recording(recorded_in_, options.overwrites, options.trajectory);
    }
    if (!options.notice.empty()) {
        notice(notice_.empty() ? options.notice : options.notice + "\n" + notice_, first_notice_s);
    }
}

WindowReport Sandbox::run() {
    shell_.run(
        options_.most_frames_per_s,
        [this] {
            if (window_.should_close()) {
                window_.keep_open();
                ask_to_quit();
            }
            frame();
            return !quitting_;
        },
        [this] { notice(translated("the graphics device was lost and has been set up again")); });
    window_.capture_cursor(false);  // that Space may have
    WindowReport report{{},    overlay_.settings(),  frame_ms_.size(),
                        0,     scale_.value(),       overlay_.lesson().steps_done(),
                        next_, frame_.readout.replay};
    report.summary = hands_.front().statistics.summary();
    report.summary.device = hands_.front().device->spec().name;
    report.summary.unbinding = session_.find_unbinding();
    for (const WindowHand& other : std::span(hands_).subspan(1)) {
        report.summary.other_hands.push_back(other.statistics.summary());
        report.summary.other_hands.back().device = other.device->spec().name;
    }
    report.summary.steps = frame_.readout.steps;
    warn_of_outcome(report.summary);
    report.summary.overruns = session_.servo_health().overruns;
    if (!frame_ms_.empty()) {
        std::nth_element(frame_ms_.begin(),
                         frame_ms_.begin() + static_cast<std::ptrdiff_t>(frame_ms_.size() / 2),
                         frame_ms_.end());
        report.median_frame_ms = frame_ms_[frame_ms_.size() / 2];
    }
    return report;
}

void Sandbox::frame() {
    const SteadyClock::time_point begin = SteadyClock::now();
    take_ticks();
    if (session_.read_frame(frame_)) {
        has_frame_ = true;
        for (WindowHand& each : hands_)
            each.statistics.add_step(frame_.readout.step_ms * 1e-3, true);
        frame_.readout.contact = in_hand().contact;
        frame_.readout.holds_something = in_hand().held.count > 0;
        tell_what_is_held();
        tell_what_is_forgotten();
        tell_what_was_edited();
        tell_recording_notes();
    }
    select_anew();
    follow_lesson();
    follow_tour();
    send_view();
    tell_of_film();
    save_for_crash();
    if (const std::vector<std::string> notes = session_.take_server_notes(); !notes.empty())
        notice(fmt::format("{}", fmt::join(notes, "\n")));
    take_input();
    look_for_devices();
    play_force();
    if (frame_ms_.size() + 1 == options_.lose_device_at) {
        frame_ms_.push_back(0);
        throw DeviceLost("the graphics device was released on request (--lose-device-at)");
    }
    is_over_ = options_.last_shot && ms_since(start_) > 1e3 * options_.last_shot_s;
    wants_shot_ = wants_shot_ || is_over_;
    if (window_.size().width == 0 || window_.size().height == 0) {  // folded away
        if (is_over_)
            throw GpuError("the window is minimised, so no screenshot was taken; restore it first");
        return;
    }
    draw();
    last_frame_ms_ = ms_since(begin);
    scale_.add_frame(last_frame_ms_);
    constexpr std::size_t most = 100'000;
    if (frame_ms_.size() < most) frame_ms_.push_back(last_frame_ms_);
}

void Sandbox::take_ticks() {
    std::vector<ServoTick> ticks(hands_.size());
    while (session_.pop_ticks(ticks)) {
        for (std::size_t slot = 0; slot < hands_.size(); ++slot) {
            const ServoTick& tick = ticks[slot];
            WindowHand& each = hands_[slot];
            each.lead.see(tick.reading.position_m, tick.contact.displacement_gain);
            each.felt_newton = tick.sent_newton.norm();
            each.waiting_m = tick.waiting_m;
            each.is_at_wall = tick.overtravel_m.norm() > least_overtravel_m;
            each.is_at_stop = tick.is_at_stop && !tick.clutched;
            if (!frame_.readout.paused) each.statistics.add(tick);
        }
        if (options_.is_over && options_.is_over(ticks.front())) quitting_ = true;
        if (frame_.readout.paused) continue;
        overlay_.add_tick(ticks[led_]);
        if (options_.study) options_.study->add(ticks.front());
    }
}

VkExtent2D Sandbox::picture_size() const {
    const VkExtent2D size = shell_.graphics()->swapchain.size();
    const auto scaled = [&](std::uint32_t pixels) {
        return std::max(1U, static_cast<std::uint32_t>(std::lround(pixels * scale_.value())));
    };
    return {scaled(size.width), scaled(size.height)};
}

void Sandbox::compose_picture() {
    if (has_frame_ && !std::exchange(has_first_picture_, has_frame_)) {
        first_picture_ = frame_.picture;
        show_first_view();
    }
    fly();
    shown_ = frame_.picture;
    if (has_frame_ && selected_.size() == frame_.atoms->names.size())
        highlight(*frame_.atoms, frame_.places, selected_, shown_);
    if (clips_ && has_frame_ && in_hand().held.count > 0)
        clip_in_front(in_hand().held, camera_, shown_);
    show_wish();
    shown_.camera = frame_camera(camera_, shown_);
    shown_.camera.centre = free_centre();
    shown_.background = window_background;
    shown_.is_coarse = true;
    shown_.occlusion = shown_.occlusion && scale_.has_effects();
    shown_.shadows = shown_.shadows && scale_.has_effects();
}

void Sandbox::draw() {
    Graphics& g = *shell_.graphics();
    if (std::exchange(must_rebuild_, false)) g.swapchain.rebuild(window_.size());
    g.ui.begin(!holding_);
    std::vector<Command> commands;
    std::vector<Action> actions;
    if (has_frame_ && options_.study) {
        draw_study_panel(*options_.study);
    } else if (has_frame_) {
        const bool is_news = SteadyClock::now() < notice_until_;
        overlay_.draw(frame_.readout,
                      {session_.servo_health(), hand().device->spec().name, g.device.name(),
                       last_frame_ms_, scale_.value(), hand().is_led(), holding_,
                       is_news ? notice_ : std::string(hand().device->status()),
                       can_choose_device() ? devices_.offers : std::vector<DeviceOffer>(),
                       devices_.current, speaker_.has_value(), hover_, session_.recorded_s(),
                       frame_.legend, selection_panel_.is_open(), hand().statistics.travel()},
                      commands, actions);
        draw_selection();
    }
    std::optional<AddEdit> wanted;
    if (has_frame_) wanted = add_panel_.draw(*frame_.atoms);
    const Answer* const answer = question_ ? draw_question(*question_) : nullptr;
    if (tour_ && at_view_ && !options_.study)
        draw_caption(saved_views_[*at_view_].name, free_area());
    compose_picture();  // now that the panels are laid out, and it is known what they leave free
    if (!options_.study) draw_view_labels(frame_.labels, shown_.camera);
    if (has_frame_ && !options_.study) draw_hand();
    g.ui.end();
    for (const Command& command : commands) session_.send(command);

    const VkExtent2D size = picture_size();
    WindowShot shot;
    const bool shows = g.swapchain.present(
        [&](VkCommandBuffer buffer, VkImage image) {
            g.renderer.record(buffer, shown_, size);
            blit(buffer, g.renderer.colour_image(), size, image, g.swapchain.size());
        },
        [&](VkCommandBuffer buffer) { g.ui.draw(buffer); },
        wants_shot_ || (film_ && film_->is_due()) ? &shot : nullptr);
    drawn_size_ = size;
    must_rebuild_ = !shows;
    if (!shot.rgba.empty() && film_ && film_->is_due())
        film_->add({shot.width, shot.height, shot.rgba, {}, {}});
    if (!shot.rgba.empty() && wants_shot_) {
        wants_shot_ = false;
        save(shot);
    }
    if (answer) return give(*answer);
    if (wanted) add(std::move(*wanted));
    for (const Action action : actions) perform(action);
    if (const std::optional<std::string> name = overlay_.take_device()) choose_device(*name);
}

void Sandbox::save(const WindowShot& shot) {
    if (is_over_ && options_.last_shot) {  // asked for on the command line: an error if it fails
        write_png(*options_.last_shot, {shot.width, shot.height, shot.rgba, {}, {}},
                  options_.last_shot_existing);
        quitting_ = true;
        return;
    }
    try {
        notice(format_translated("saved {}", save_screenshot(options_.screenshots, shot).string()));
    } catch (const LoadError& error) {
        notice(error.what());
    }
}

void Sandbox::notice(std::string text, double seconds) {
    notice_ = std::move(text);
    notice_until_ = SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(
                                             std::chrono::duration<double>(seconds));
}

WindowReport run_window(WindowShell& shell, const SceneDescription& scene, Device& device,
                        const WindowOptions& options) {
    const std::vector<WindowHand> hands = list_window_hands(device, options);
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
    const bool is_loaded = shell.work(format_translated("Opening {}", scene.title), load);
    WindowReport report;
    if (is_loaded) {
        report = Sandbox(shell, std::move(session), scene, device, options).run();
    } else {
        report.next.emplace();
    }
    shell.check_validation();
    return report;
}

}  // namespace palpa
