#include "app/draw_window.h"

#include "app/camera.h"
#include "app/editing.h"
#include "app/hands.h"
#include "app/panels.h"
#include "app/recorder.h"
#include "app/saved_views.h"
#include "app/selecting.h"
#include "app/window_world.h"
#include "ui/axes.h"
#include "ui/caption.h"
#include "ui/colours.h"
#include "ui/study_panel.h"
#include "ui/view_labels.h"
#include "view/clip.h"
#include "view/selected_atoms.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace palpa {
namespace {

VkExtent2D scaled_size(const World& app) {
    const VkExtent2D size = shell_of(app).graphics()->swapchain.size();
    const double scale = app.resource<PictureState>().scale.value();
    const auto scaled = [&](std::uint32_t pixels) {
        return std::max(1U, static_cast<std::uint32_t>(std::lround(pixels * scale)));
    };
    return {scaled(size.width), scaled(size.height)};
}

// The frame's picture with selection, clipping, wishes and camera.
void compose_picture(World& app) {
    PictureState& picture = app.write<PictureState>();
    const LiveFrame& frame = frame_of(app);
    if (has_frame(app) && !std::exchange(picture.has_first, has_frame(app))) {
        picture.first = frame.picture;
        show_first_view(app);
    }
    fly(app);
    const CameraState& camera = app.resource<CameraState>();
    const std::vector<bool>& selected = app.resource<SelectionState>().atoms;
    FrameScene& shown = picture.shown;
    shown = frame.picture;
    if (has_frame(app) && selected.size() == frame.atoms->names.size())
        highlight(*frame.atoms, frame.places, selected, shown);
    if (camera.clips && has_frame(app) && led_hand(app).held.count > 0)
        clip_in_front(led_hand(app).held, camera.now, shown);
    show_hand_targets(app);
    shown.camera = frame_camera(camera.now, shown);
    shown.camera.centre = free_centre(app);
    shown.background = colours().background;
    shown.is_coarse = true;
    shown.occlusion = shown.occlusion && picture.scale.has_effects();
    shown.shadows = shown.shadows && picture.scale.has_effects();
}

// Gives the answer, which goes with its question.
void give(World& app, const Answer& answer) {
    const std::function<void()> then = answer.then;
    app.write<Dialogs>().question.reset();
    if (then) then();
}

void draw_over_picture(World& app) {
    if (is_study(app)) return;
    const SavedViewState& views = app.resource<SavedViewState>();
    if (views.tour && views.at) draw_caption(views.all[*views.at].name, free_area(app));
    draw_axes(app.resource<CameraState>().now, free_area(app));
    draw_view_labels(frame_of(app).labels, app.resource<PictureState>().shown.camera);
    if (has_frame(app)) draw_hand_signs(app);
    draw_box(app);
}

void present(World& app) {
    Graphics& graphics = *shell_of(app).graphics();
    PictureState& picture = app.write<PictureState>();
    const VkExtent2D size = scaled_size(app);
    WindowShot shot;
    const bool shows = graphics.swapchain.present(
        [&](VkCommandBuffer buffer, VkImage image) {
            graphics.renderer.record(buffer, picture.shown, size);
            stretch_over(buffer, graphics.renderer, size, image, graphics.swapchain.size());
        },
        [&](VkCommandBuffer buffer) { graphics.ui.draw(buffer); },
        wants_shot(app) ? &shot : nullptr);
    picture.drawn_size = size;
    picture.must_rebuild = !shows;
    if (!shot.rgba.empty()) save_shot(app, shot);
}

// Gives the device up at the frame that a test names, and asks for the last screenshot in time.
void follow_command_line(World& app) {
    const WindowOptions& options = options_of(app);
    FrameLoop& loop = app.write<FrameLoop>();
    if (loop.frame_ms.size() + 1 == options.lose_device_at) {
        loop.frame_ms.push_back(0);
        throw DeviceLost("the graphics device was released on request (--lose-device-at)");
    }
    loop.takes_last_shot = options.last_shot && seconds_since(loop.start) > options.last_shot_s;
    if (!loop.takes_last_shot) return;
    take_screenshot(app);
    if (is_minimised(app))
        throw GpuError("the window is minimised, so no screenshot was taken; restore it first");
}

}  // namespace

bool is_minimised(const World& app) {
    const VkExtent2D size = shell_of(app).window().size();
    return size.width == 0 || size.height == 0;
}

void draw_window(World& app) {
    follow_command_line(app);
    if (is_minimised(app)) return;
    WindowShell& shell = shell_of(app);
    Graphics& graphics = *shell.graphics();
    if (std::exchange(app.write<PictureState>().must_rebuild, false))
        graphics.swapchain.rebuild(shell.window().size());
    graphics.ui.begin(!app.resource<WindowHands>().holds);
    std::vector<PanelRequest> requests;
    if (has_frame(app) && is_study(app)) draw_study_panel(*options_of(app).study);
    if (has_frame(app) && !is_study(app)) requests = draw_panels(app);
    std::optional<AddEdit> wanted;
    if (has_frame(app)) wanted = app.write<Dialogs>().add.draw(*frame_of(app).atoms);
    const std::optional<Question>& question = app.resource<Dialogs>().question;
    const Answer* const answer = question ? draw_question(*question) : nullptr;
    compose_picture(app);  // panels are laid out now: it is known what they leave free
    draw_over_picture(app);
    graphics.ui.end();
    present(app);
    if (answer) return give(app, *answer);
    if (wanted) add_molecule(app, std::move(*wanted));
    for (const PanelRequest& request : requests) request(app);
}

}  // namespace palpa
