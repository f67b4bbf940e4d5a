// The constant Vulkan objects of the renderer: passes, pipelines and descriptors.
#pragma once
#include "gpu/device.h"

#include <span>

namespace palpa {

// Storage buffers that shaders read or write, and the images of what is seen, by the camera and
// by the sun, in binding order.
struct FrameResources {
    VkBuffer shapes = VK_NULL_HANDLE, vertices = VK_NULL_HANDLE, layers = VK_NULL_HANDLE;
    VkImageView seen = VK_NULL_HANDLE, sun_seen = VK_NULL_HANDLE;
};

// Handles for use; do not change them.
class Pipelines {
public:
    explicit Pipelines(const GpuDevice& device);
    Pipelines(const Pipelines&) = delete;
    Pipelines& operator=(const Pipelines&) = delete;
    ~Pipelines();

    // Call while no commands that read the set are in flight.
    void write_descriptors(VkDescriptorSet written, const FrameResources& resources) const;

    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE, sun_set = VK_NULL_HANDLE;

    // Writes `seen` and depth.
    VkRenderPass shape_pass = VK_NULL_HANDLE;
    VkPipeline spheres = VK_NULL_HANDLE, cones = VK_NULL_HANDLE, triangles = VK_NULL_HANDLE;
    VkPipeline layers = VK_NULL_HANDLE;  // writes the lists of layers instead

    // Into the colours, where depth lets it. `shade_meshes` is `shade` where triangles are seen
    // too, `shade_all` with shadows as well; `compose` lays the layers over what is there.
    VkRenderPass picture_pass = VK_NULL_HANDLE;
    VkPipeline shade = VK_NULL_HANDLE, shade_meshes = VK_NULL_HANDLE, shade_all = VK_NULL_HANDLE,
               outline = VK_NULL_HANDLE, compose = VK_NULL_HANDLE;

    // Into `seen` as it is: the nearest layer where nothing is opaque.
    VkRenderPass again_pass = VK_NULL_HANDLE;
    VkPipeline nearest = VK_NULL_HANDLE;

private:
    struct Kind;

    explicit Pipelines(VkDevice device) : device_(device) {}

    void create_passes();
    void create_layout();
    void create_sets();
    void create_pipelines();
    VkPipeline create_pipeline(std::span<const std::uint32_t> vertex_code,
                               std::span<const std::uint32_t> fragment_code,
                               const Kind& kind) const;

    VkDevice device_;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkSampler sampler_ = VK_NULL_HANDLE;
};

}  // namespace palpa
