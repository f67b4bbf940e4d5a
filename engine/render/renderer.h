// Draws a FrameScene without a window: spheres and cones as impostors, deferred.
#pragma once
#include "gpu/device.h"
#include "gpu/resources.h"
#include "render/frame_scene.h"
#include "render/picture.h"

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace palpa {

// Two passes. The first finds for every pixel which shape is nearest and how far; the second shades
// each pixel once: light from the camera's upper left, ambient occlusion from eight taps of the
// depth around, a dark outline where depth breaks off.
class Renderer {
public:
    // Throws GpuError.
    explicit Renderer(GpuDevice& device);
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    // Throws GpuError if the size is 0 or beyond what the device can do.
    Picture draw(const FrameScene& scene, std::uint32_t width, std::uint32_t height);

private:
    void create_passes();
    void create_pipelines();
    VkPipeline create_pipeline(VkShaderModule vertex, VkShaderModule fragment, VkRenderPass pass,
                               bool has_depth) const;
    Picture read_back(const FrameScene& scene, const Buffer& colour, const Buffer& ids,
                      const Buffer& depth, VkExtent2D size) const;

    GpuDevice& device_;
    VkRenderPass shape_pass_ = VK_NULL_HANDLE, resolve_pass_ = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkSampler sampler_ = VK_NULL_HANDLE;
    VkPipeline spheres_ = VK_NULL_HANDLE, cones_ = VK_NULL_HANDLE, resolve_ = VK_NULL_HANDLE;
};

// From the world to the camera, and from the camera to the picture's plane, for whoever asks where
// something will be seen: pixel coordinates from the upper left, and the depth in Å.
glm::mat4 view_matrix(const FrameCamera& camera);
glm::vec3 project(const FrameCamera& camera, const glm::vec3& point, std::uint32_t width,
                  std::uint32_t height);

}  // namespace palpa
