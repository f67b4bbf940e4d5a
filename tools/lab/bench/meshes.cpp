#include "tools/lab/bench/meshes.h"

#include "gpu/device.h"
#include "render/renderer.h"

#include <fmt/format.h>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace palpa {
namespace {

// A sphere with bumps, as a molecule's surface has them.
MeshShape bumpy_sphere(std::uint32_t rings) {
    MeshShape mesh;
    const std::uint32_t row = 2 * rings + 1;
    for (std::uint32_t i = 0; i < (rings + 1) * row; ++i) {
        const float step = std::numbers::pi_v<float> / static_cast<float>(rings),
                    polar = step * static_cast<float>(i / row),
                    around = step * static_cast<float>(i % row);
        const glm::vec3 out(std::sin(polar) * std::cos(around), std::cos(polar),
                            -std::sin(polar) * std::sin(around));
        const float bump = std::sin(5 * out.x) * std::sin(4 * out.y + 1) * std::sin(6 * out.z);
        mesh.vertices.push_back({2.5F * (1 + 0.12F * bump) * out, out, {0.8F, 0.5F, 0.3F}, i});
    }
    for (std::uint32_t ring = 0; ring < rings; ++ring) {
        for (std::uint32_t sector = 0; sector + 1 < row; ++sector) {
            const std::uint32_t a = ring * row + sector, b = a + row;
            mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    }
    return mesh;
}

struct Look {
    std::string_view name;
    float opacity;
    bool is_closed;
};

}  // namespace

void bench_meshes(std::vector<BenchRow>& rows) {
    constexpr int warm_up = 5, frames = 60;
    constexpr VkExtent2D size{640, 360};
    GpuDevice gpu{GpuOptions{}};
    Renderer renderer(gpu);
    FrameScene frame;
    frame.meshes = {bumpy_sphere(122)};
    for (const Look& look :
         {Look{"closed", 1, true}, Look{"open", 1, false}, Look{"translucent", 0.4F, true}}) {
        frame.meshes[0].opacity = look.opacity;
        frame.meshes[0].is_closed = look.is_closed;
        const auto draw = [&] {
            gpu.submit([&](VkCommandBuffer commands) { renderer.record(commands, frame, size); });
        };
        for (int i = 0; i < warm_up; ++i) draw();
        rows.push_back({fmt::format("render/mesh/{}x{}/triangles={}/{}", size.width, size.height,
                                    frame.meshes[0].indices.size() / 3, look.name),
                        sample(frames, 1e3, draw), "ms"});
    }
}

}  // namespace palpa
