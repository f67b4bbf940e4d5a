// The view from one place: shapes and triangles on the device, and the images into which they are
// drawn.
#pragma once
#include "gpu/resources.h"
#include "render/frame_scene.h"
#include "render/gpu_frame.h"
#include "render/mesh_lists.h"
#include "render/pipelines.h"

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

namespace palpa {

class ShapeView {
public:
    ShapeView(const GpuDevice& device, const Pipelines& pipelines);

    // Builds everything for the frame, and records what brings it to the device. Buffers and images
    // may be others afterwards. Throws GpuError for a bad mesh.
    void upload(VkCommandBuffer commands, const std::vector<MeshShape>& meshes,
                const std::vector<SphereShape>& spheres, const std::vector<ConeShape>& cones,
                const glm::mat4& view, const GpuFrame& frame);

    // Begins the first pass with descriptors of this view, whose frame the following commands have
    // too; within it, that many of the spheres and cones, and opaque triangles, are drawn.
    void begin(VkCommandBuffer commands, VkDescriptorSet set, const GpuFrame& frame) const;
    void draw_opaque(VkCommandBuffer commands, std::size_t spheres, std::size_t cones) const;
    void draw_layers(VkCommandBuffer commands) const;

    const MeshLists& meshes() const noexcept { return meshes_; }
    VkExtent2D size() const noexcept { return size_; }
    const Image& seen() const noexcept { return seen_; }
    const Image& depth() const noexcept { return depth_; }
    const Framebuffer& framebuffer() const noexcept { return framebuffer_; }
    VkBuffer shapes() const noexcept { return shapes_.handle(); }
    VkBuffer vertices() const noexcept { return vertices_.handle(); }

private:
    void create_images(VkExtent2D size);
    void upload_shapes(VkCommandBuffer commands, const std::vector<SphereShape>& spheres,
                       const std::vector<ConeShape>& cones, const glm::mat4& view);
    void draw_triangles(VkCommandBuffer commands, VkPipeline pipeline,
                        const TriangleRange& range) const;

    const GpuDevice* device_;
    const Pipelines* pipelines_;
    VkExtent2D size_{0, 0};
    Image seen_, depth_;  // seen: number of shape or triangle, and distance
    Framebuffer framebuffer_;
    MeshLists meshes_;
    UploadBuffer shapes_, vertices_;
};

// Draws this number of vertices, which the shader generates.
void draw_vertices(VkCommandBuffer commands, VkPipeline pipeline, std::size_t vertices);

void begin_pass(VkCommandBuffer commands, VkRenderPass pass, const Framebuffer& framebuffer,
                VkExtent2D size, std::span<const VkClearValue> clear);

}  // namespace palpa
