#include "app/saved_views.h"

#include "app/camera.h"
#include "app/notices.h"
#include "app/window_world.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "molecule/select.h"
#include "view/saved_views.h"

#include <fmt/format.h>
#include <utility>

namespace palpa {
namespace {

constexpr std::chrono::seconds tour_stop{5};

}  // namespace

const std::vector<bool>& find_framed(World& app, const std::string& selection) {
    SavedViewState& views = app.write<SavedViewState>();
    views.framed_now.clear();
    views.problem.clear();
    if (selection.empty()) return views.framed_now;
    const auto found = views.framed.find(selection);
    if (found != views.framed.end()) return found->second;
    try {
        const Selection parsed = parse_selection(selection);
        views.framed_now = select_as_seen(session_of(app).copy_world(), selection);
        if (!is_constant(parsed)) return views.framed_now;
        return views.framed[selection] = views.framed_now;
    } catch (const LoadError& error) {
        views.problem = error.what();
        views.framed_now.clear();
        return views.framed_now;
    }
}

void go_to_view(World& app, std::size_t number) {
    SavedViewState& views = app.write<SavedViewState>();
    const SavedView& saved = views.all[number];
    views.at = number;
    app.write<PictureState>().view.representation =
        saved.representation.value_or(options_of(app).view.representation);
    CameraState& camera = app.write<CameraState>();
    camera.clips = camera.looks_at_held = false;
    fly_to(app, saved_camera(saved, frame_of(app).places, find_framed(app, saved.look_at),
                             free_room(app)));
}

void go_to_next_view(World& app) {
    if (!has_frame(app)) return;
    const SavedViewState& views = app.resource<SavedViewState>();
    if (views.all.empty())
        return tell(app, translated("no view is saved yet; Shift+W saves this view"));
    go_to_view(app, views.at ? (*views.at + 1) % views.all.size() : 0);
    const SavedViewState& now = app.resource<SavedViewState>();
    if (!now.problem.empty()) return tell(app, now.problem);
    if (!now.tour)
        tell(app, format_translated("{} ({} of {})", now.all[*now.at].name, *now.at + 1,
                                    now.all.size()));
}

void add_view(World& app) {
    if (!has_frame(app)) return;
    SavedViewState& views = app.write<SavedViewState>();
    const PictureState& picture = app.resource<PictureState>();
    const ViewDescription& first = scene_of(app).view;
    SavedView saved{.name = find_free_view_name(views.all)};
    if (views.at) {
        saved.look_at = views.all[*views.at].look_at;
        saved.layers = views.all[*views.at].layers;
    } else if (!first.look_at.empty()) {
        saved.look_at = fmt::format("molecule \"{}\"", first.look_at);
    }
    if (picture.view.representation != options_of(app).view.representation)
        saved.representation = picture.view.representation;
    const CameraState& state = app.resource<CameraState>();
    const OrbitCamera& camera = state.flight ? state.flight->to : state.now;
    const std::vector<glm::vec3>& places = frame_of(app).places;
    set_camera(saved, camera, places, find_framed(app, saved.look_at), free_room(app));
    if (!views.problem.empty()) {
        saved.look_at.clear();
        set_camera(saved, camera, places, {}, free_room(app));
    }
    views.tour.reset();
    tell(app, format_translated(
                  "view saved as {}; W shows the saved views, Ctrl+S writes them to a scene file",
                  saved.name));
    views.all.push_back(std::move(saved));
    views.at = views.all.size() - 1;
}

void begin_or_end_tour(World& app) {
    if (end_tour(app)) return;
    SavedViewState& views = app.write<SavedViewState>();
    views.at.reset();
    views.tour = SteadyClock::now();
}

bool end_tour(World& app) {
    return std::exchange(app.write<SavedViewState>().tour, std::nullopt).has_value();
}

void follow_tour(World& app) {
    const auto& tour = app.resource<SavedViewState>().tour;
    if (!tour || SteadyClock::now() < *tour) return;
    go_to_next_view(app);
    app.write<SavedViewState>().tour = SteadyClock::now() + tour_stop;
}

}  // namespace palpa
