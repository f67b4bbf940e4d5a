#include "app/camera.h"

#include "app/editing.h"
#include "app/notices.h"
#include "app/panels.h"
#include "app/saved_views.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/colours.h"
#include "ui/shown_names.h"
#include "view/build_frame.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <vector>

namespace palpa {
namespace {

constexpr float around_held = 1.6F;      // times the distance that fits the molecule in hand alone
constexpr float around_selected = 1.3F;  // the same for selected atoms
constexpr double flight_s = 0.6;

VkExtent2D window_size(const World& app) {
    if (WindowShell* const shell = app.resource<WindowLinks>().shell) return shell->window().size();
    const ImVec2 size = ImGui::GetIO().DisplaySize;  // without a window, in tests
    return {static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y)};
}

void look_at_held(World& app) {
    take_camera(app);
    CameraState& camera = app.write<CameraState>();
    frame_shapes(camera.now, shapes_of(frame_of(app).picture, led_hand(app).held), free_room(app));
    zoom(camera.now, around_held);
    camera.clips = camera.looks_at_held = true;
}

// `said`: an English format of the notice.
template <typename Value>
void choose_next(World& app, Value ViewSettings::* choice, std::size_t count, const char* said) {
    ViewSettings& view = app.write<PictureState>().view;
    view.*choice = static_cast<Value>((static_cast<std::size_t>(view.*choice) + 1) % count);
    tell(app, fmt::format(fmt::runtime(translated(said)), shown_name(view.*choice)));
}

}  // namespace

ScreenArea free_area(const World& app) {
    const VkExtent2D size = window_size(app);
    const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
    return is_study(app) ? ScreenArea{0, 0, width, height}
                         : app.resource<Docks>().picture_area(width, height);
}

glm::vec2 free_centre(const World& app) {
    const VkExtent2D size = window_size(app);
    const auto width = static_cast<float>(std::max(size.width, 1U));
    const auto height = static_cast<float>(std::max(size.height, 1U));
    const ScreenArea area = free_area(app);
    return {(area.left + area.right) / width - 1, 1 - (area.top + area.bottom) / height};
}

glm::vec2 target_pixel(const World& app) {
    const ScreenArea area = free_area(app);
    return {0.5F * (area.left + area.right), 0.5F * (area.top + area.bottom)};
}

Room free_room(const World& app) {
    const auto height = static_cast<float>(std::max(window_size(app).height, 1U));
    const ScreenArea area = free_area(app);
    return {area.width() / height, area.height() / height};
}

void take_camera(World& app) {
    app.write<CameraState>().flight.reset();
    app.write<SavedViewState>().tour.reset();
}

void fly_to(World& app, const OrbitCamera& to) {
    CameraState& camera = app.write<CameraState>();
    camera.flight = {camera.now, to, SteadyClock::now()};
}

void fly(World& app) {
    CameraState& camera = app.write<CameraState>();
    if (!camera.flight) return;
    const auto share = static_cast<float>(seconds_since(camera.flight->begin) / flight_s);
    camera.now = between(camera.flight->from, camera.flight->to, eased(share));
    if (share >= 1) camera.flight.reset();
}

void show_first_view(World& app) {
    take_camera(app);
    app.write<SavedViewState>().at.reset();
    const ViewDescription& first = scene_of(app).view;
    PictureState& picture = app.write<PictureState>();
    CameraState& camera = app.write<CameraState>();
    camera.now = first_camera(first, picture.first, frame_of(app).framed, free_room(app));
    camera.clips = first.clip;
    camera.looks_at_held = false;
    picture.view = options_of(app).view;
}

void look_at_all(World& app) {
    take_camera(app);
    CameraState& camera = app.write<CameraState>();
    frame_all(camera.now, frame_of(app).picture, free_room(app));
    camera.clips = camera.looks_at_held = false;
}

void look_at_held_or_all(World& app) {
    const bool looks_at_held = app.resource<CameraState>().looks_at_held;
    if (looks_at_held) {
        look_at_all(app);
        tell(app, translated("all atoms are shown"));
    } else if (led_hand(app).held.count == 0) {
        tell(app, translated("nothing is in hand; click on an atom first"));
    } else {
        look_at_held(app);
        tell(app,
             translated("atoms in front of the molecule in hand are hidden; F shows them again"));
    }
}

void look_at_selected_or_ligand(World& app) {
    if (!has_frame(app)) return;
    const std::vector<glm::vec3>& places = frame_of(app).places;
    std::vector<bool> wanted = app.resource<SelectionState>().atoms;
    if (wanted.empty()) wanted = find_framed(app, "ligand");
    std::vector<SphereShape> balls;
    for (std::size_t i = 0; i < std::min(wanted.size(), places.size()); ++i)
        if (wanted[i]) balls.push_back({places[i], 1.7F});
    if (balls.empty())
        return tell(app, translated("nothing is selected and the scene has no ligand; select atoms "
                                    "first (Ctrl+F)"));
    OrbitCamera camera = app.resource<CameraState>().now;
    frame_shapes(camera, balls, free_room(app));
    zoom(camera, around_selected);
    take_camera(app);
    fly_to(app, camera);
}

void look_at_pixel(World& app, double x, double y) {
    const std::optional<std::uint32_t> atom = find_atom(app, x, y);
    if (!atom) return;
    for (const SphereShape& sphere : frame_of(app).picture.spheres) {
        if (sphere.pick != *atom) continue;
        take_camera(app);
        app.write<CameraState>().now.target = sphere.centre;
        return;
    }
}

void choose_next_representation(World& app) {
    choose_next(app, &ViewSettings::representation, representation_names.size(),
                for_translation("shown as {}"));
}

void choose_next_colouring(World& app) {
    choose_next(app, &ViewSettings::colouring, colouring_names.size(),
                for_translation("coloured by {}"));
}

// Adds what a person added, and the layers of the saved view that is shown.
void send_view(World& app) {
    PictureState& picture = app.write<PictureState>();
    ViewSettings wanted = picture.view;
    const ViewAdditions& additions = app.resource<ViewAdditions>();
    wanted.layers = additions.layers;
    wanted.labels = additions.labels;
    wanted.hidden = additions.hidden;
    wanted.marks.measures = additions.measures;
    const SavedViewState& views = app.resource<SavedViewState>();
    if (views.at) {
        const std::vector<ViewLayer>& layers = views.all[*views.at].layers;
        wanted.layers.insert(wanted.layers.end(), layers.begin(), layers.end());
    }
    wanted.background = colours().background;
    if (wanted == picture.sent) return;
    picture.sent = wanted;
    send(app, wanted);
}

ViewDescription describe_view(const World& app) {
    const ViewDescription& first = scene_of(app).view;
    const PictureState& picture = app.resource<PictureState>();
    const CameraState& camera = app.resource<CameraState>();
    const Representation usual = options_of(app).view.representation;
    ViewDescription view = first;
    view.saved = app.resource<SavedViewState>().all;
    view.colouring = picture.view.colouring;
    if (picture.view.representation != usual) {
        view.representation = picture.view.representation;
        // A saved view without one was seen as the scene was.
        for (SavedView& saved : view.saved)
            if (!saved.representation) saved.representation = usual;
    }
    const LiveFrame& frame = frame_of(app);
    view.camera = describe_camera(camera.now, first, frame.picture, frame.framed, free_room(app));
    view.clip = camera.clips;
    const ViewAdditions& additions = app.resource<ViewAdditions>();
    view.layers = additions.layers;
    view.labels = additions.labels;
    view.hidden = additions.hidden;
    view.marks = picture.view.marks;
    view.marks.measures = additions.measures;
    view.shadows = picture.view.shadows;
    return view;
}

}  // namespace palpa
