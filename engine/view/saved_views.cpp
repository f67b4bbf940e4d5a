#include "view/saved_views.h"

#include "math/angles.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

// All atoms alike, so that a view does not depend on how they are drawn.
std::vector<SphereShape> balls_of(std::span<const glm::vec3> places,
                                  const std::vector<bool>& framed) {
    constexpr float radius = 1.7F;  // Å
    std::vector<SphereShape> balls;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (i < framed.size() && framed[i]) balls.push_back({places[i], radius});
    if (!balls.empty()) return balls;
    for (const glm::vec3& place : places) balls.push_back({place, radius});
    return balls;
}

double rounded(double value, double parts) { return std::round(parts * value) / parts; }

// To three digits.
double rounded_to_digits(double value) {
    return value > 0 ? rounded(value, std::pow(10, 2 - std::floor(std::log10(value)))) : 0;
}

}  // namespace

const SavedView* find_saved_view(std::span<const SavedView> views, std::string_view name) {
    const auto found = std::ranges::find(views, name, &SavedView::name);
    return found == views.end() ? nullptr : &*found;
}

std::string find_free_view_name(std::span<const SavedView> views) {
    for (int number = 1;; ++number) {
        std::string name = fmt::format("view {}", number);
        if (!find_saved_view(views, name)) return name;
    }
}

OrbitCamera saved_camera(const SavedView& saved, std::span<const glm::vec3> places,
                         const std::vector<bool>& framed, const Room& room) {
    const auto [azimuth_deg, elevation_deg, nearer] = saved.camera;
    OrbitCamera camera;
    orbit(camera, static_cast<float>(azimuth_deg / degrees_per_radian),
          static_cast<float>(elevation_deg / degrees_per_radian));
    frame_shapes(camera, balls_of(places, framed), room);
    zoom(camera, static_cast<float>(1 / nearer));
    const auto& [x, y, z] = saved.shift;
    camera.target += glm::vec3(x, y, z);
    return camera;
}

void set_camera(SavedView& saved, const OrbitCamera& camera, std::span<const glm::vec3> places,
                const std::vector<bool>& framed, const Room& room) {
    constexpr double turn = 360, least_zoom = 0.01, most_zoom = 100;
    saved.camera = {rounded(std::remainder(camera.azimuth * degrees_per_radian, turn), 10),
                    rounded(camera.elevation * degrees_per_radian, 10), 1};
    saved.shift = {};
    const OrbitCamera straight = saved_camera(saved, places, framed, room);
    const double zoom = static_cast<double>(straight.distance) / camera.distance;
    saved.camera[2] = std::clamp(rounded_to_digits(zoom), least_zoom, most_zoom);
    const glm::vec3 shift = camera.target - straight.target;
    const auto component = [](double value) {
        constexpr double longest = 1e4;  // Å, that the key takes
        return std::clamp(rounded(value, 100), -longest, longest);
    };
    saved.shift = {component(shift.x), component(shift.y), component(shift.z)};
}

}  // namespace palpa
