#include "app/run_window.h"

#include "app/live_session.h"
#include "app/render_scale.h"
#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/units.h"
#include "gpu/swapchain.h"
#include "platform/window.h"
#include "render/picture.h"
#include "render/renderer.h"
#include "session/run_headless.h"
#include "sound/speaker.h"
#include "ui/backend.h"
#include "ui/question.h"
#include "ui/study_panel.h"
#include "ui/view_labels.h"
#include "view/build_frame.h"
#include "view/clip.h"
#include "view/first_view.h"
#include "view/orbit_camera.h"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace palpa {
namespace {

using Clock = std::chrono::steady_clock;

constexpr float radians_per_pixel = 0.008F;
constexpr float zoom_per_notch = 0.9F;
constexpr double angstrom_per_notch = 0.25;  // of the molecule in hand, towards the eye and away
// Of what the handle stays behind the mouse: the medium hand's newton is 1.2 Å, and leaves the
// atom.
constexpr double thread_angstrom_per_m = 240;
constexpr double key_angstrom_per_s = 2, slow_key = 0.2;
constexpr double longest_key_s = 0.1;  // that counts at once
constexpr double notice_s = 4, first_notice_s = 15;
constexpr std::chrono::seconds device_look{1};
constexpr double text_step = 1.1;
constexpr float surroundings = 1.6F;  // times the distance that fits the molecule in hand alone
constexpr glm::vec3 background{0.86F, 0.89F, 0.93F};

// All that is lost with a device, made and thrown away as one.
struct Graphics {
    Graphics(const Window& window, bool validation, double text_scale)
        : device({.validation = validation,
                  .instance_extensions = window.vulkan_extensions(),
                  .create_surface =
                      [&window](VkInstance instance) { return window.create_surface(instance); }}),
          swapchain(device, window.size()),
          renderer(device),
          ui(window, device, swapchain.overlay_pass(), swapchain.image_count(),
             static_cast<float>(text_scale) * window.content_scale()) {}

    GpuDevice device;
    Swapchain swapchain;
    Renderer renderer;
    UiBackend ui;
};

double ms_since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

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

std::filesystem::path next_screenshot(const std::filesystem::path& folder) {
    for (int number = 1;; ++number) {
        std::filesystem::path path = folder / fmt::format("palpa-{:04}.png", number);
        std::error_code error;
        if (!std::filesystem::exists(path, error)) return path;
    }
}

class Sandbox {
public:
    Sandbox(const SceneDescription& scene, Device& device, const WindowOptions& options)
        : options_(options),
          devices_(options.devices),
          device_(&device),
          orders_(options.orders),
          mouse_reach_m_(options.mouse_reach_m),
          text_scale_(options.text_scale.scale),
          window_("Palpa - " + scene.title, options.width, options.height),
          session_(scene, options.view, device, options.orders),
          overlay_(scene),
          saved_(overlay_.settings()),
          statistics_(servo_tick_s),
          first_(scene.view),
          view_(options.view),
          clips_(scene.view.clip) {
        std::error_code error;
        if (!std::filesystem::is_directory(options.screenshots, error)) {
            throw LoadError({options.screenshots.string()},
                            "is no folder; expected one for screenshots");
        }
        if (options.grows) window_.grow_with_display();
        // Drawing, which may be done by threads of the driver, comes after feeling.
        (void)nice(5);
        graphics_ = std::make_unique<Graphics>(window_, options.validation, text_scale_);
        if (options.sound.is_on) (void)switch_sound(true);
        if (!options.notice.empty()) {
            notice(notice_.empty() ? options.notice : options.notice + "\n" + notice_,
                   first_notice_s);
        }
    }

    WindowReport run();

private:
    void frame();
    void show_first_view();
    void look_at_all();
    void look_at_grabbed();
    ScreenArea free_area() const;
    glm::vec2 free_centre() const;
    Room free_room() const;
    void compose_picture();
    void look_at_grabbed_or_all();
    void show_as(const ViewSettings& view);
    void choose_next_representation();
    void choose_next_colouring();
    bool has_mouse_hand() const { return orders_ && mouse_reach_m_ > 0; }
    bool can_choose_device() const { return devices_.open && !options_.study; }
    void look_for_devices();
    bool change_device(const std::string& name);
    bool choose_device(const std::string& name);
    void choose_next_device();
    bool switch_sound(bool is_on);
    void choose_sound();
    void play_force();
    void take_ticks();
    void take_input();
    void move_camera(const Input& input);
    void heed_device(const Input& input);
    void post_pad(const Input& input);
    void move_hand(const Input& input);
    void move_hand_by_keys(const Input& input, double seconds);
    void pull(const glm::vec3& way);
    void show_wish();
    void perform(Action action);
    void press_study_key();
    void press_key(const KeyPress& press);
    void give(const Answer& answer);
    bool save_scene();
    ViewDescription describe_view() const;
    void ask_to_quit();
    void ask_for_stand_in();
    bool is_stand_in(const std::string& name) const;
    void change_text_scale(double scale);
    void look_at_pixel(double x, double y);
    void draw();
    void save(const WindowShot& shot);
    void restart_graphics();
    void notice(std::string text, double seconds = notice_s);
    VkExtent2D picture_size() const;
    void keep_validation_messages();

    const WindowOptions options_;
    DeviceMenu devices_;
    std::unique_ptr<Device> chosen_;  // in the place of the one that the window began with
    Device* device_;
    HandOrders* orders_;
    double mouse_reach_m_;
    double text_scale_;  // over the display's own
    Clock::time_point next_look_ = Clock::now();
    Window window_;
    LiveSession session_;
    std::unique_ptr<Graphics> graphics_;
    Overlay overlay_;
    LiveSettings saved_;  // as the scene's file has them, or the file saved last
    std::optional<Question> question_;
    Statistics statistics_;
    std::optional<Speaker> speaker_;  // while sound is on

    LiveFrame frame_;
    bool has_frame_ = false;
    const ViewDescription first_;
    FrameScene first_picture_;  // empty until there is one
    OrbitCamera camera_;
    ViewSettings view_;
    bool clips_;  // what hides the molecule in hand is left out
    bool looks_at_grabbed_ = false;
    Vec3 hand_m_ = Vec3::Zero();    // where the mouse wants the handle
    Vec3 handle_m_ = Vec3::Zero();  // where it is
    double displacement_gain_ = 0;  // A_d at this moment
    double felt_newton_ = 0;        // sent to the device at this moment
    FrameScene shown_;              // the frame's picture, and what the window puts in it
    Clock::time_point last_input_ = Clock::now();
    VkExtent2D drawn_size_{};  // of the last picture
    bool holding_ = false;
    bool drags_panel_ = false;                 // the drag that is under way, or was the last one
    Clock::time_point heeded_ = Clock::now();  // the device, for the last time
    RenderScale scale_;
    const Clock::time_point start_ = Clock::now();
    bool is_over_ = false;  // the last screenshot is due
    bool quitting_ = false, wants_shot_ = false, must_rebuild_ = false;
    std::string notice_;
    std::string refusal_;      // of the device that was tried last
    bool has_looked_ = false;  // for the device that is wanted
    Clock::time_point notice_until_{};
    std::vector<double> frame_ms_;
    std::vector<std::string> validation_messages_;
    double last_frame_ms_ = 0;
};

WindowReport Sandbox::run() {
    const auto shortest = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1 / options_.most_frames_per_s));
    constexpr int most_losses = 3;  // without a picture in between
    int losses = 0;
    Clock::time_point next = Clock::now();
    note_interrupts();
    while (!quitting_ && noted_interrupt() == 0) {
        if (window_.should_close()) {
            window_.keep_open();
            ask_to_quit();
        }
        try {
            if (losses > 0 || !graphics_) restart_graphics();
            frame();
            losses = 0;
        } catch (const DeviceLost&) {
            if (++losses > most_losses) throw;
            notice("the graphics device was lost, and is back");
        }
        // The display's own pace does not throttle everywhere.
        next = std::max(next + shortest, Clock::now());
        std::this_thread::sleep_until(next);
    }
    keep_validation_messages();
    if (!validation_messages_.empty()) throw GpuError("validation: " + validation_messages_[0]);
    WindowReport report{statistics_.summary(), overlay_.settings(),           frame_ms_.size(), 0,
                        scale_.value(),        overlay_.lesson().steps_done()};
    report.summary.device = device_->spec().name;
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
    const Clock::time_point begin = Clock::now();
    take_ticks();
    if (session_.read_frame(frame_)) {
        has_frame_ = true;
        statistics_.add_step(frame_.readout.step_ms * 1e-3, true);
    }
    take_input();
    look_for_devices();
    play_force();
    if (frame_ms_.size() + 1 == options_.lose_device_at) {
        frame_ms_.push_back(0);
        throw DeviceLost("the device was given up on request");
    }
    is_over_ = options_.last_shot && ms_since(start_) > 1e3 * options_.last_shot_s;
    wants_shot_ = wants_shot_ || is_over_;
    if (window_.size().width == 0 || window_.size().height == 0) {  // folded away
        if (is_over_) throw GpuError("the window is folded away: no picture of it");
        return;
    }
    draw();
    last_frame_ms_ = ms_since(begin);
    scale_.add_frame(last_frame_ms_);
    constexpr std::size_t most = 100'000;
    if (frame_ms_.size() < most) frame_ms_.push_back(last_frame_ms_);
}

ScreenArea Sandbox::free_area() const {
    const auto width = static_cast<float>(window_.size().width);
    const auto height = static_cast<float>(window_.size().height);
    return options_.study ? ScreenArea{0, 0, width, height} : overlay_.free_area(width, height);
}

glm::vec2 Sandbox::free_centre() const {
    const auto width = static_cast<float>(std::max(window_.size().width, 1U));
    const auto height = static_cast<float>(std::max(window_.size().height, 1U));
    const ScreenArea area = free_area();
    return {(area.left + area.right) / width - 1, 1 - (area.top + area.bottom) / height};
}

Room Sandbox::free_room() const {
    const auto height = static_cast<float>(std::max(window_.size().height, 1U));
    const ScreenArea area = free_area();
    return {area.width() / height, area.height() / height};
}

// As it was when the window opened, wherever the molecules are now.
void Sandbox::show_first_view() {
    camera_ = first_camera(first_, first_picture_, frame_.framed, free_room());
    clips_ = first_.clip;
    looks_at_grabbed_ = false;
    show_as(options_.view);
}

void Sandbox::look_at_all() {
    frame_all(camera_, frame_.picture, free_room());
    clips_ = looks_at_grabbed_ = false;
}

void Sandbox::look_at_grabbed() {
    frame_shapes(camera_, shapes_of(frame_.picture, {0, frame_.grabbed_atoms}), free_room());
    zoom(camera_, surroundings);
    clips_ = looks_at_grabbed_ = true;
}

void Sandbox::look_at_grabbed_or_all() {
    if (looks_at_grabbed_) {
        look_at_all();
        notice("everything is shown");
    } else {
        look_at_grabbed();
        notice("what stands in front of the molecule in hand is left out; F shows everything");
    }
}

void Sandbox::show_as(const ViewSettings& view) {
    if (view_ == view) return;
    view_ = view;
    session_.send(view_);
}

void Sandbox::choose_next_representation() {
    ViewSettings view = view_;
    const std::size_t next =
        (static_cast<std::size_t>(view.representation) + 1) % representation_names.size();
    view.representation = static_cast<Representation>(next);
    show_as(view);
    notice(fmt::format("shown as {}", representation_names[next]));
}

void Sandbox::choose_next_colouring() {
    ViewSettings view = view_;
    const std::size_t next =
        (static_cast<std::size_t>(view.colouring) + 1) % colouring_names.size();
    view.colouring = static_cast<Colouring>(next);
    show_as(view);
    notice(fmt::format("coloured by {}", colouring_names[next]));
}

void Sandbox::take_ticks() {
    for (ServoTick tick; session_.pop_tick(tick);) {
        handle_m_ = tick.reading.position_m;
        if (tick.touch.displacement_gain > 0) displacement_gain_ = tick.touch.displacement_gain;
        felt_newton_ = tick.sent_newton.norm();
        if (frame_.readout.paused) continue;
        statistics_.add(tick);
        overlay_.add_tick(tick);
        if (options_.study) options_.study->add(tick);
    }
}

void Sandbox::take_input() {
    const Input& input = window_.poll();
    must_rebuild_ = must_rebuild_ || input.resized;
    if (input.rescaled) restart_graphics();
    heed_device(input);
    if (options_.pads) post_pad(input);
    if (!graphics_->ui.wants_keys()) {
        for (const KeyPress& press : input.pressed) press_key(press);
    }
    const bool leads = has_mouse_hand() && !graphics_->ui.wants_keys() && !question_;
    const double seconds = 1e-3 * ms_since(std::exchange(last_input_, Clock::now()));
    if (leads) move_hand_by_keys(input, std::min(seconds, longest_key_s));
    holding_ = leads && input.is_held(Key::Space);
    window_.capture_cursor(holding_);
    // A drag belongs to what lies where it began, however fast the mouse goes.
    for (const MousePress& press : input.clicked) {
        drags_panel_ = graphics_->ui.covers(press.x, press.y);
    }
    const bool is_dragging =
        std::find(input.down.begin(), input.down.end(), true) != input.down.end();
    const bool is_on_panel = is_dragging || !input.clicked.empty()
                                 ? drags_panel_
                                 : graphics_->ui.covers(input.mouse_x, input.mouse_y);
    if (holding_) {
        move_hand(input);
    } else if (!is_on_panel && !question_) {
        move_camera(input);
        if (input.double_clicked) look_at_pixel(input.mouse_x, input.mouse_y);
    }
}

void Sandbox::move_camera(const Input& input) {
    const auto dx = static_cast<float>(input.mouse_dx), dy = static_cast<float>(input.mouse_dy);
    const bool shifts = input.is_down(MouseButton::Right) || input.is_down(MouseButton::Middle) ||
                        (input.is_down(MouseButton::Left) && input.shift);
    if (shifts) {
        pan(camera_, dx, dy, static_cast<float>(window_.size().height));
    } else if (input.is_down(MouseButton::Left)) {
        orbit(camera_, -radians_per_pixel * dx, radians_per_pixel * dy);
    }
    if (input.wheel != 0) zoom(camera_, std::pow(zoom_per_notch, static_cast<float>(input.wheel)));
}

// Without focus its sticks are meant for others.
void Sandbox::post_pad(const Input& input) {
    PadInput pad{.is_there = input.pad.has_value()};
    if (input.pad && input.focused) {
        const PadState& state = *input.pad;
        pad = {true,          state.left_x,  state.left_y,
               state.right_x, state.right_y, state.right_shoulder};
    }
    options_.pads->inputs.post(pad);
    options_.pads->is_there = pad.is_there;
}

// What it is told without focus is meant for others.
void Sandbox::heed_device(const Input& input) {
    device_->attend(input.focused);
    constexpr double longest_s = 0.1;  // after a pause nothing leaps
    const double passed_s = std::chrono::duration<double>(Clock::now() - heeded_).count();
    heeded_ = Clock::now();
    carry(camera_, device_->view_rate(), std::min(passed_s, longest_s));
}

void Sandbox::move_hand(const Input& input) {
    const float scale = angstrom_per_pixel(camera_, as_float(frame_.grabbed_angstrom),
                                           static_cast<float>(window_.size().height));
    pull(scale * (static_cast<float>(input.mouse_dx) * rightward(camera_) -
                  static_cast<float>(input.mouse_dy) * upward(camera_)) -
         static_cast<float>(input.wheel * angstrom_per_notch) * backward(camera_));
}

void Sandbox::move_hand_by_keys(const Input& input, double seconds) {
    const auto along = [&](Key forth, Key back) {
        return static_cast<float>(input.is_held(forth)) - static_cast<float>(input.is_held(back));
    };
    const glm::vec3 way = along(Key::Right, Key::Left) * rightward(camera_) +
                          along(Key::Up, Key::Down) * upward(camera_) -
                          along(Key::PageUp, Key::PageDown) * backward(camera_);
    if (way == glm::vec3(0)) return;
    pull(static_cast<float>(key_angstrom_per_s * (input.shift ? slow_key : 1) * seconds) * way);
}

// The molecule would go this way (Å) where nothing holds it: handle travel is A_d times its way.
void Sandbox::pull(const glm::vec3& way) {
    hand_m_ += Vec3(way.x, way.y, way.z) * units::metre_per_angstrom * displacement_gain_;
    // Never further ahead than the hand pulls: so that coming back is felt at once.
    const double ahead = (hand_m_ - handle_m_).norm();
    if (ahead > mouse_reach_m_) {
        hand_m_ = handle_m_ + (hand_m_ - handle_m_) * (mouse_reach_m_ / ahead);
    }
    session_.move_hand(hand_m_);
}

// A study shows nothing of it.
void Sandbox::show_wish() {
    if (!has_mouse_hand() || options_.study) return;
    const Vec3 wish = frame_.grabbed_angstrom + thread_angstrom_per_m * (hand_m_ - handle_m_);
    add_wish(as_float(frame_.grabbed_angstrom), as_float(wish), backward(camera_), shown_);
}

// Of what a study leaves to a person: where to look, and the way out.
bool is_of_picture(Action action) {
    return action == Action::Focus || action == Action::FrameAll || action == Action::FirstView ||
           action == Action::Screenshot || action == Action::RestartGraphics ||
           action == Action::LargerText || action == Action::SmallerText ||
           action == Action::UsualText || action == Action::Quit;
}

void Sandbox::press_key(const KeyPress& press) {
    if (question_) {
        const Answer* const answer = press.control ? nullptr : find_answer(*question_, press.key);
        if (answer) return give(*answer);
        if (find_action(press.key, press.control) != Action::Screenshot) return;
    }
    if (options_.study && press.key == Key::Enter) return press_study_key();
    if (const std::optional<Action> action = find_action(press.key, press.control)) {
        perform(*action);
    }
}

void Sandbox::give(const Answer& answer) {
    const std::function<void()> then = answer.then;  // the answer goes with its question
    question_.reset();
    if (then) then();
}

// As it is seen now, for a scene's file.
ViewDescription Sandbox::describe_view() const {
    ViewDescription view = first_;
    view.colouring = view_.colouring;
    if (view_.representation != options_.view.representation) {
        view.representation = view_.representation;
    }
    view.camera = describe_camera(camera_, first_, first_picture_, frame_.framed, free_room());
    view.clip = clips_;
    return view;
}

bool Sandbox::save_scene() {
    if (!options_.save) return false;
    try {
        const std::string file = options_.save(overlay_.settings(), describe_view());
        saved_ = overlay_.settings();
        notice(fmt::format("saved {}", file), first_notice_s);
        return true;
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
        return false;
    }
}

void Sandbox::ask_to_quit() {
    if (options_.study || !options_.save || overlay_.settings() == saved_) {
        quitting_ = true;
        return;
    }
    question_ = {"The settings were changed and are not saved.",
                 {{Key::S, "Save and quit (S)", [this] { quitting_ = save_scene(); }},
                  {Key::Q, "Quit without saving (Q)", [this] { quitting_ = true; }},
                  {Key::Escape, "Stay (Esc)"}}};
}

void Sandbox::change_text_scale(double scale) {
    // Panels need 900 pixels of width at the usual size; beyond a little more they would be cut.
    constexpr double smallest = 0.7, largest = 4, needed_pixels = 900, too_wide = 1.2;
    const double fits = too_wide * window_.size().width / (needed_pixels * window_.content_scale());
    text_scale_ = std::clamp(scale, smallest, std::clamp(fits, 1.0, largest));
    restart_graphics();
    notice(fmt::format("text: {:.0f} %", 100 * text_scale_));
    if (!options_.text_scale.remember) return;
    try {
        options_.text_scale.remember(text_scale_);
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
        if (has_mouse_hand()) session_.move_hand(hand_m_ = handle_m_);
        session_.send(Reset{study.start_angstrom()});
    }
    if (study.results().size() > before && options_.on_trial) options_.on_trial();
}

void Sandbox::perform(Action action) {
    if (options_.study && !is_of_picture(action)) return;
    if (action == Action::Reset) show_first_view();
    if (action == Action::Reset && has_mouse_hand()) session_.move_hand(hand_m_ = handle_m_);
    std::vector<Command> commands;
    if (overlay_.perform(action, commands)) {
        for (const Command& command : commands) session_.send(command);
        return;
    }
    switch (action) {
        case Action::NextRepresentation:
            choose_next_representation();
            break;
        case Action::NextColouring:
            choose_next_colouring();
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
        case Action::NextDevice:
            choose_next_device();
            break;
        case Action::ToggleSound:
            choose_sound();
            break;
        case Action::Screenshot:
            wants_shot_ = true;
            break;
        case Action::RestartGraphics:
            restart_graphics();
            break;
        case Action::Save:
            (void)save_scene();
            break;
        case Action::LargerText:
            change_text_scale(text_scale_ * text_step);
            break;
        case Action::SmallerText:
            change_text_scale(text_scale_ / text_step);
            break;
        case Action::UsualText:
            change_text_scale(1);
            break;
        case Action::Quit:
            if (options_.study || !overlay_.close_something()) ask_to_quit();
            break;
        default:
            break;
    }
}

// One that was wanted, and was not there, is taken when it comes.
void Sandbox::look_for_devices() {
    if (!can_choose_device() || Clock::now() < next_look_) return;
    next_look_ = Clock::now() + device_look;
    bool is_wanted_there = false;
    for (DeviceOffer& offer : devices_.offers) {
        offer.is_there = devices_.is_there(offer.name);
        is_wanted_there = is_wanted_there || (offer.name == devices_.wanted && offer.is_there);
    }
    if (!is_wanted_there) {
        refusal_.clear();
        if (!devices_.wanted.empty() && !std::exchange(has_looked_, true) && notice_.empty()) {
            notice(
                fmt::format("{} is not there; until it is: {}", devices_.wanted, devices_.current),
                first_notice_s);
        }
    } else if (change_device(devices_.wanted)) {  // or it is tried again: a node may open later
        devices_.wanted.clear();
    }
}

bool Sandbox::change_device(const std::string& name) {
    WindowDevice next;
    try {
        next = devices_.open(name);
        session_.change_device(*next.device, next.orders);
    } catch (const LoadError& error) {
        if (error.what() != refusal_) notice(error.what(), first_notice_s);
        refusal_ = error.what();
        return false;
    }
    refusal_.clear();
    chosen_ = std::move(next.device);
    device_ = chosen_.get();
    orders_ = next.orders;
    mouse_reach_m_ = next.mouse_reach_m;
    hand_m_ = handle_m_ = Vec3::Zero();
    devices_.current = name;
    notice(fmt::format("device: {}", device_->spec().name));
    return true;
}

bool Sandbox::choose_device(const std::string& name) {
    refusal_.clear();
    if (name != devices_.current && !change_device(name)) return false;
    devices_.wanted.clear();
    if (is_stand_in(name)) {
        notice(fmt::format("{}, for this session; D goes back", device_->spec().name),
               first_notice_s);
        return true;
    }
    try {
        devices_.remember(name);
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
    }
    return true;
}

bool Sandbox::is_stand_in(const std::string& name) const {
    return std::any_of(
        devices_.offers.begin(), devices_.offers.end(),
        [&](const DeviceOffer& offer) { return offer.name == name && offer.is_stand_in; });
}

void Sandbox::ask_for_stand_in() {
    const auto found = std::find_if(devices_.offers.begin(), devices_.offers.end(),
                                    [](const DeviceOffer& offer) { return offer.is_stand_in; });
    if (found == devices_.offers.end() || found->name == devices_.current) return;
    question_ = {
        "No other device was found ('palpa devices' says why). Take an emulated one for "
        "this session: " +
            found->summary + "?",
        {{Key::Y, "Yes (Y)", [this, name = found->name] { (void)choose_device(name); }},
         {Key::Escape, "No (Esc)"}}};
}

// What is there and cannot be used is said, and passed over.
void Sandbox::choose_next_device() {
    if (!can_choose_device()) return;
    const auto& offers = devices_.offers;
    const auto current = std::find_if(offers.begin(), offers.end(), [&](const DeviceOffer& offer) {
        return offer.name == devices_.current;
    });
    const std::size_t from = current == offers.end()
                                 ? offers.size() - 1
                                 : static_cast<std::size_t>(current - offers.begin());
    std::string refusals;
    for (std::size_t i = 1; i < offers.size(); ++i) {
        const DeviceOffer& next = offers[(from + i) % offers.size()];
        if (!next.is_there || next.is_stand_in) continue;
        if (choose_device(next.name)) {
            if (!refusals.empty()) notice(refusals + notice_, first_notice_s);
            return;
        }
        refusals += refusal_ + "\n";
    }
    if (refusals.empty()) ask_for_stand_in();
}

// False where it stays off.
bool Sandbox::switch_sound(bool is_on) {
    speaker_.reset();
    if (!is_on) return true;
    try {
        speaker_.emplace();
    } catch (const SoundError& error) {
        notice(fmt::format("{}: no tone", error.what()), first_notice_s);
        return false;
    }
    return true;
}

void Sandbox::choose_sound() {
    if (!switch_sound(!speaker_)) return;
    notice(speaker_ ? "sound on: the higher and louder the tone, the stronger the force"
                    : "sound off");
    if (!options_.sound.remember) return;
    try {
        options_.sound.remember(speaker_.has_value());
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
    }
}

// While paused the hand feels nothing.
void Sandbox::play_force() {
    if (!speaker_) return;
    if (speaker_->is_there())
        return speaker_->play(tone_of(frame_.readout.paused ? 0 : felt_newton_));
    speaker_.reset();
    notice("the sound output has gone away: no tone", first_notice_s);
}

void Sandbox::look_at_pixel(double x, double y) {
    const VkExtent2D window = graphics_->swapchain.size();
    if (drawn_size_.width == 0 || window.width == 0 || window.height == 0) return;
    graphics_->swapchain.wait();
    const std::uint32_t pick = graphics_->renderer.pick(
        static_cast<std::uint32_t>(std::max(x, 0.0) * drawn_size_.width / window.width),
        static_cast<std::uint32_t>(std::max(y, 0.0) * drawn_size_.height / window.height));
    for (const SphereShape& sphere : frame_.picture.spheres) {
        if (sphere.pick != pick) continue;
        camera_.target = sphere.centre;
        return;
    }
}

VkExtent2D Sandbox::picture_size() const {
    const VkExtent2D size = graphics_->swapchain.size();
    const auto scaled = [&](std::uint32_t pixels) {
        return std::max(1U, static_cast<std::uint32_t>(std::lround(pixels * scale_.value())));
    };
    return {scaled(size.width), scaled(size.height)};
}

void Sandbox::compose_picture() {
    if (has_frame_ && first_picture_.spheres.empty()) {
        first_picture_ = frame_.picture;
        show_first_view();
    }
    shown_ = frame_.picture;
    if (clips_) clip_in_front(frame_.grabbed_atoms, camera_, shown_);
    show_wish();
    shown_.camera = frame_camera(camera_, shown_);
    shown_.camera.centre = free_centre();
    shown_.background = background;
    shown_.occlusion = scale_.has_effects();
}

void Sandbox::draw() {
    Graphics& g = *graphics_;
    if (std::exchange(must_rebuild_, false)) g.swapchain.rebuild(window_.size());
    g.ui.begin();
    std::vector<Command> commands;
    std::vector<Action> actions;
    if (has_frame_ && options_.study) {
        draw_study_panel(*options_.study);
    } else if (has_frame_) {
        const bool is_news = Clock::now() < notice_until_;
        overlay_.draw(frame_.readout,
                      {session_.servo_health(), device_->spec().name, g.device.name(),
                       last_frame_ms_, scale_.value(), has_mouse_hand(), holding_,
                       is_news ? notice_ : std::string(device_->status()),
                       can_choose_device() ? devices_.offers : std::vector<DeviceOffer>(),
                       devices_.current, speaker_.has_value()},
                      commands, actions);
    }
    const Answer* const answer = question_ ? draw_question(*question_) : nullptr;
    compose_picture();  // now that the panels are laid out, and it is known what they leave free
    if (!options_.study) draw_view_labels(frame_.labels, shown_.camera);
    g.ui.end();
    for (const Command& command : commands) session_.send(command);

    const VkExtent2D size = picture_size();
    WindowShot shot;
    const bool shows = g.swapchain.present(
        [&](VkCommandBuffer buffer, VkImage image) {
            g.renderer.record(buffer, shown_, size);
            blit(buffer, g.renderer.colour_image(), size, image, g.swapchain.size());
        },
        [&](VkCommandBuffer buffer) { g.ui.draw(buffer); }, wants_shot_ ? &shot : nullptr);
    drawn_size_ = size;
    must_rebuild_ = !shows;
    if (!shot.rgba.empty()) {
        wants_shot_ = false;
        save(shot);
    }
    if (answer) return give(*answer);
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
    const std::filesystem::path path = next_screenshot(options_.screenshots);
    try {
        write_png(path, {shot.width, shot.height, shot.rgba, {}, {}});
        notice(fmt::format("saved {}", path.string()));
    } catch (const LoadError& error) {
        notice(error.what());
    }
}

void Sandbox::restart_graphics() {
    keep_validation_messages();
    graphics_.reset();
    drawn_size_ = {};
    graphics_ = std::make_unique<Graphics>(window_, options_.validation, text_scale_);
}

void Sandbox::keep_validation_messages() {
    if (!graphics_) return;
    for (const std::string& message : graphics_->device.validation_messages()) {
        validation_messages_.push_back(message);
    }
}

void Sandbox::notice(std::string text, double seconds) {
    notice_ = std::move(text);
    notice_until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(seconds));
}

}  // namespace

WindowReport run_window(const SceneDescription& scene, Device& device,
                        const WindowOptions& options) {
    return Sandbox(scene, device, options).run();
}

}  // namespace palpa
