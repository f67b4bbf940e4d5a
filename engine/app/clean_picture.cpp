#include "app/clean_picture.h"

#include "app/camera.h"
#include "app/window_world.h"
#include "ui/colours.h"
#include "view/clip.h"
#include "view/picks.h"
#include "view/worded_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace palpa {
namespace {

// The angle under which what was seen between the panels fits into a picture of this aspect.
float fit_angle(float vertical_angle, const Room& room, float aspect) {
    const float share = std::max(room.height, room.width / aspect);
    return 2 * std::atan(share * std::tan(0.5F * vertical_angle));
}

void leave_out_arrow(FrameScene& scene) {
    const auto is_arrow = [](const auto& shape) { return shape.pick == arrow_pick; };
    std::erase_if(scene.spheres, is_arrow);
    std::erase_if(scene.cones, is_arrow);
}

}  // namespace

Picture draw_clean_picture(World& app, const CleanPicture& wanted, std::string* problem) {
    const LiveFrame& frame = frame_of(app);
    const CameraState& camera = app.resource<CameraState>();
    WordedFrame worded{frame.picture, {}};
    if (wanted.has_words) worded.words = {frame.labels, frame.legend};
    FrameScene& scene = worded.scene;
    if (camera.clips && led_hand(app).held.count > 0)
        clip_in_front(led_hand(app).held, camera.now, scene);
    if (!wanted.has_arrow) leave_out_arrow(scene);
    scene.camera = frame_camera(camera.now, scene);
    const float aspect = static_cast<float>(wanted.width) / static_cast<float>(wanted.height);
    scene.camera.vertical_angle = fit_angle(scene.camera.vertical_angle, free_room(app), aspect);
    // White as palpa render draws it, but for a dark theme.
    scene.background =
        is_dark_theme() ? app.resource<PictureState>().sent.background : glm::vec3{1};
    scene.clear_background = wanted.is_clear;
    scene.is_fine = true;
    Graphics& graphics = *shell_of(app).graphics();
    graphics.swapchain.wait();  // the renderer's last frame is done
    std::vector<std::string> warnings;
    std::optional<TextPainter> painter;
    if (wanted.has_words) painter = open_words(warnings);
    if (problem && !warnings.empty()) *problem = warnings.front();
    app.write<PictureState>().drawn_size = {};  // the renderer knows this picture's atoms now
    return draw_worded(graphics.renderer, {wanted.width, wanted.height, wanted.samples}, worded,
                       painter);
}

}  // namespace palpa
