#include "view/first_view.h"

#include "math/angles.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace palpa {

ViewSettings first_settings(const ViewDescription& view, const World& world) {
    constexpr std::size_t many = 300;
    const bool hides = world.resource<AtomTable>().size() > many;
    return {.representation = view.representation.value_or(hides ? Representation::Pocket
                                                                 : Representation::BallAndStick),
            .colouring = view.colouring,
            .hydrogen_bonds = view.hydrogen_bonds,
            .layers = view.layers,
            .labels = view.labels,
            .hydrogens = view.hydrogens,
            .shadows = view.shadows,
            .occlusion = view.occlusion,
            .outline = static_cast<int>(view.outline),
            .hidden = view.hidden,
            .marks = view.marks};
}

AtomRange framed_atoms(const ViewDescription& view, const World& world) {
    AtomRange framed;
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        if (molecule.name == view.look_at) framed = molecule.atoms;
    });
    return framed;
}

OrbitCamera first_camera(const ViewDescription& view, const FrameScene& frame,
                         const AtomRange& framed, const Room& room) {
    constexpr double radian = std::numbers::pi / 180;
    const auto [azimuth_deg, elevation_deg, nearer] = view.camera;
    OrbitCamera camera;
    orbit(camera, static_cast<float>(azimuth_deg * radian),
          static_cast<float>(elevation_deg * radian));
    if (framed.count == 0) {
        frame_all(camera, frame, room);
    } else {
        frame_shapes(camera, shapes_of(frame, framed), room);
    }
    zoom(camera, static_cast<float>(1 / nearer));
    return camera;
}

std::array<double, 3> describe_camera(const OrbitCamera& camera, const ViewDescription& view,
                                      const FrameScene& frame, const AtomRange& framed,
                                      const Room& room) {
    constexpr double most_deg = 180;
    constexpr double least_zoom = 0.01, most_zoom = 100;
    ViewDescription straight = view;
    const double azimuth = std::remainder(camera.azimuth * degrees_per_radian, 2 * most_deg);
    straight.camera = {azimuth, camera.elevation * degrees_per_radian, 1};
    const double zoom =
        first_camera(straight, frame, framed, room).distance / static_cast<double>(camera.distance);
    return {std::round(10 * azimuth) / 10,
            std::round(10 * camera.elevation * degrees_per_radian) / 10,
            std::clamp(std::round(100 * zoom) / 100, least_zoom, most_zoom)};
}

}  // namespace palpa
