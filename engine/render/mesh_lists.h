// The visible triangles of a frame's meshes in view space.
#pragma once
#include "render/frame_scene.h"
#include "render/gpu_frame.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

namespace palpa {

// A range of triangles.
struct TriangleRange {
    std::size_t first = 0, count = 0;
    std::size_t end() const noexcept { return first + count; }
};

// Triangle k has the corners 3k to 3k + 2. Nothing is shared, so that a corner says which triangle
// it is of; corners by index measured the same on lavapipe.
class MeshLists {
public:
    // Throws GpuError where a mesh has an index too large, or indices that make no triangles.
    void build(const std::vector<MeshShape>& meshes, const glm::mat4& view, const GpuFrame& frame);

    const std::vector<GpuVertex>& vertices() const noexcept { return vertices_; }
    // Pick of each triangle.
    std::span<const std::uint32_t> picks() const noexcept { return picks_; }

    // Those wholly in the picture stand apart from those across its edges: see frame.glsl on
    // `nowhere`.
    TriangleRange opaque_inside() const noexcept { return ranges_[0]; }
    TriangleRange opaque_across() const noexcept { return ranges_[1]; }
    TriangleRange translucent_inside() const noexcept { return ranges_[2]; }
    TriangleRange translucent_across() const noexcept { return ranges_[3]; }
    bool has_opaque() const noexcept { return ranges_[0].count + ranges_[1].count > 0; }
    bool has_translucent() const noexcept { return ranges_[2].count + ranges_[3].count > 0; }

private:
    struct Corners {
        std::array<std::uint32_t, 3> of;  // indices into `placed_`
        std::uint32_t pick;
    };

    void add_mesh(const MeshShape& mesh, const glm::mat4& view, const GpuFrame& frame);
    void number_triangles();

    // Reused between frames for their memory.
    std::vector<GpuVertex> placed_;
    std::vector<std::uint8_t> outside_;  // for each vertex: the sides of the view that it is beyond
    std::array<std::vector<Corners>, 4> kinds_;

    std::vector<GpuVertex> vertices_;
    std::vector<std::uint32_t> picks_;
    std::array<TriangleRange, 4> ranges_{};
};

}  // namespace palpa
