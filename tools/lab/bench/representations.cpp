#include "tools/lab/bench/representations.h"

#include "gpu/device.h"
#include "render/renderer.h"
#include "simulation/resources.h"
#include "view/build_frame.h"
#include "view/orbit_camera.h"

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <random>
#include <string_view>

namespace palpa {
namespace {

constexpr std::array shown{Representation::BallAndStick, Representation::SpaceFilling,
                           Representation::Pocket, Representation::Cartoon,
                           Representation::Surface};

ViewSettings settings_of(Representation representation) {
    return {.representation = representation};
}

// As a flexible scene moves between two frames.
void shake(World& world, std::mt19937& random) {
    std::normal_distribution<double> way(0, 0.03);  // Å
    for (Vec3& place : world.write<AtomTable>().positions)
        place += Vec3(way(random), way(random), way(random));
}

void bench_building(const std::string& name, World& world, Representation representation,
                    std::vector<BenchRow>& rows) {
    const std::string_view look = representation_names[static_cast<std::size_t>(representation)];
    const ViewSettings settings = settings_of(representation);
    rows.push_back({fmt::format("build/{}/{}", name, look),
                    sample(7, 1e3, [&] { (void)build_frame(world, {}, settings); }), "ms"});
    FrameBuilder builder;
    (void)builder.build(world, {}, settings);
    std::mt19937 random(1);
    World moving = world;
    rows.push_back({fmt::format("build/{}/{}/moving", name, look),
                    sample(15, 1e3,
                           [&] {
                               shake(moving, random);
                               (void)builder.build(moving, {}, settings);
                           }),
                    "ms"});
}

}  // namespace

void bench_representations(const std::string& scene_name, World world,
                           std::vector<BenchRow>& rows) {
    constexpr int warm_up = 5, frames = 40;
    GpuDevice gpu{GpuOptions{}};
    Renderer renderer(gpu);
    for (const Representation representation : shown) {
        bench_building(scene_name, world, representation, rows);
        FrameScene frame = build_frame(world, settings_of(representation));
        for (const VkExtent2D size : {VkExtent2D{640, 360}, VkExtent2D{1280, 720}}) {
            OrbitCamera camera;
            frame_all(camera, frame, 16.0F / 9);
            frame.camera = frame_camera(camera, frame);
            const auto time = [&](const char* what, const auto& draw) {
                for (int i = 0; i < warm_up; ++i) draw();
                const auto look = representation_names[static_cast<std::size_t>(representation)];
                rows.push_back({fmt::format("render/{}/{}x{}/{}{}", scene_name, size.width,
                                            size.height, look, what),
                                sample(frames, 1e3, draw), "ms"});
            };
            time("", [&] {
                gpu.submit(
                    [&](VkCommandBuffer commands) { renderer.record(commands, frame, size); });
            });
            time("/read-back",
                 [&] { renderer.draw(frame, size.width, size.height, PictureContent::Colours); });
        }
    }
}

void bench_large_pictures(const std::string& scene_name, World world, std::vector<BenchRow>& rows) {
    constexpr int warm_up = 2, frames = 9;
    constexpr VkExtent2D size{1280, 720};
    GpuDevice gpu{GpuOptions{}};
    Renderer renderer(gpu);
    for (const Representation representation :
         {Representation::BallAndStick, Representation::SpaceFilling, Representation::Lines,
          Representation::Cartoon}) {
        const ViewSettings settings = settings_of(representation);
        FrameBuilder builder;
        FrameScene frame = builder.build(world, {}, settings);
        OrbitCamera camera;
        frame_all(camera, frame, 16.0F / 9);
        frame.camera = frame_camera(camera, frame);
        frame.is_coarse = true;  // as in the window
        const auto build = [&] { (void)builder.build(world, {}, settings); };
        const auto draw = [&] {
            gpu.submit([&](VkCommandBuffer commands) { renderer.record(commands, frame, size); });
        };
        const auto time = [&](const char* what, const auto& work) {
            for (int i = 0; i < warm_up; ++i) work();
            const auto look = representation_names[static_cast<std::size_t>(representation)];
            rows.push_back({fmt::format("large/{}/atoms={}/{}/{}", scene_name,
                                        world.resource<AtomTable>().size(), look, what),
                            sample(frames, 1e3, work), "ms"});
        };
        time("build", build);
        time("draw", draw);
        time("frame", [&] {
            build();
            draw();
        });
    }
}

}  // namespace palpa
