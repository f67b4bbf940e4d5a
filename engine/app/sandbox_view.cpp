// What is seen, and how large.
#include "app/sandbox.h"

#include "core/load_error.h"
#include "core/translate.h"
#include "view/build_frame.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {
namespace {

constexpr float surroundings = 1.6F;  // times the distance that fits the molecule in hand alone

}  // namespace

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

// Where the target is seen.
glm::vec2 Sandbox::target_pixel() const {
    const ScreenArea area = free_area();
    return {0.5F * (area.left + area.right), 0.5F * (area.top + area.bottom)};
}

// Whatever moved the camera by itself ends.
void Sandbox::take_camera() {
    flight_.reset();
    tour_.reset();
}

// As it was when the window opened, wherever the molecules are now; what was added stays.
void Sandbox::show_first_view() {
    take_camera();
    at_view_.reset();
    camera_ = first_camera(first_, first_picture_, frame_.framed, free_room());
    clips_ = first_.clip;
    looks_at_grabbed_ = false;
    show_as(options_.view);
}

void Sandbox::look_at_all() {
    take_camera();
    frame_all(camera_, frame_.picture, free_room());
    clips_ = looks_at_grabbed_ = false;
}

void Sandbox::look_at_grabbed() {
    take_camera();
    frame_shapes(camera_, shapes_of(frame_.picture, in_hand().held), free_room());
    zoom(camera_, surroundings);
    clips_ = looks_at_grabbed_ = true;
}

void Sandbox::look_at_grabbed_or_all() {
    if (!looks_at_grabbed_ && in_hand().held.count == 0) {
        notice(translated("nothing is in hand; click on an atom first"));
    } else if (looks_at_grabbed_) {
        look_at_all();
        notice(translated("all atoms are shown"));
    } else {
        look_at_grabbed();
        notice(translated("atoms in front of the molecule in hand are hidden; F shows them again"));
    }
}

void Sandbox::show_as(const ViewSettings& view) { view_ = view; }

// With what was added, and the layers of the saved view that is shown.
void Sandbox::send_view() {
    ViewSettings wanted = view_;
    const ViewAdditions& additions = overlay_.additions();
    wanted.layers = additions.layers;
    wanted.labels = additions.labels;
    wanted.hidden = additions.hidden;
    if (at_view_) {
        const std::vector<ViewLayer>& layers = saved_views_[*at_view_].layers;
        wanted.layers.insert(wanted.layers.end(), layers.begin(), layers.end());
    }
    wanted.background = window_background;
    if (wanted == sent_) return;
    sent_ = wanted;
    session_.send(sent_);
}

void Sandbox::look_at_pixel(double x, double y) {
    const std::optional<std::uint32_t> atom = find_atom(x, y);
    for (const SphereShape& sphere : frame_.picture.spheres) {
        if (sphere.pick != atom) continue;
        take_camera();
        camera_.target = sphere.centre;
        return;
    }
}

// As it is seen now, for a scene's file.
ViewDescription Sandbox::describe_view() const {
    ViewDescription view = first_;
    view.saved = saved_views_;
    view.colouring = view_.colouring;
    if (view_.representation != options_.view.representation) {
        view.representation = view_.representation;
        // Those without one are seen as the scene was.
        for (SavedView& saved : view.saved)
            if (!saved.representation) saved.representation = options_.view.representation;
    }
    view.camera = describe_camera(camera_, first_, frame_.picture, frame_.framed, free_room());
    view.clip = clips_;
    const ViewAdditions& additions = overlay_.additions();
    view.layers = additions.layers;
    view.labels = additions.labels;
    view.hidden = additions.hidden;
    return view;
}

}  // namespace palpa
