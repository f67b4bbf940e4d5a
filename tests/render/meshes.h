// Meshes for tests, from closed formulas.
#pragma once
#include "render/frame_scene.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace palpa::test {

// `rings` from pole to pole and twice as many sectors: 4 rings (rings - 1) triangles of area.
inline MeshShape sphere_mesh(const glm::vec3& centre, float radius, const glm::vec3& colour,
                             std::uint32_t pick, std::uint32_t rings) {
    MeshShape mesh;
    for (std::uint32_t ring = 0; ring <= rings; ++ring) {
        for (std::uint32_t sector = 0; sector <= 2 * rings; ++sector) {
            const float polar = std::numbers::pi_v<float> * static_cast<float>(ring) /
                                static_cast<float>(rings),
                        around = std::numbers::pi_v<float> * static_cast<float>(sector) /
                                 static_cast<float>(rings);
            const glm::vec3 out(std::sin(polar) * std::cos(around), std::cos(polar),
                                -std::sin(polar) * std::sin(around));
            mesh.vertices.push_back({centre + radius * out, out, colour, pick});
        }
    }
    const std::uint32_t row = 2 * rings + 1;
    for (std::uint32_t ring = 0; ring < rings; ++ring) {
        for (std::uint32_t sector = 0; sector + 1 < row; ++sector) {
            const std::uint32_t a = ring * row + sector, b = a + row;
            if (ring > 0) mesh.indices.insert(mesh.indices.end(), {a, b, a + 1});
            if (ring + 1 < rings) mesh.indices.insert(mesh.indices.end(), {a + 1, b, b + 1});
        }
    }
    return mesh;
}

// The parallelogram around a centre, from -u-v to u+v, whose outside looks along u x v.
inline MeshShape plane_mesh(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v,
                            const glm::vec3& colour, std::uint32_t pick, float opacity = 1) {
    MeshShape mesh;
    const glm::vec3 normal = glm::normalize(glm::cross(u, v));
    for (const glm::vec3& corner :
         std::array{centre - u - v, centre + u - v, centre + u + v, centre - u + v}) {
        mesh.vertices.push_back({corner, normal, colour, pick});
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.opacity = opacity;
    return mesh;
}

}  // namespace palpa::test
