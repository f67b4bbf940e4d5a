#include "render/renderer.h"

#include "render/gpu_frame.h"

#include <fmt/format.h>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <span>

namespace palpa {
namespace {

// Whether the buffer is another one now, so that descriptors name one that is gone.
template <class Element>
bool upload(VkCommandBuffer commands, UploadBuffer& buffer, std::span<const Element> elements) {
    const bool moved = buffer.reserve(elements.size_bytes());
    if (!elements.empty()) {
        std::memcpy(buffer.mapped().data(), elements.data(), elements.size_bytes());
    }
    buffer.record(commands, elements.size_bytes());
    return moved;
}

void draw_vertices(VkCommandBuffer commands, VkPipeline pipeline, std::size_t vertices) {
    if (vertices == 0) return;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, static_cast<std::uint32_t>(vertices), 1, 0, 0);
}

void begin_pass(VkCommandBuffer commands, VkRenderPass pass, const Framebuffer& framebuffer,
                VkExtent2D size, std::span<const VkClearValue> clear) {
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = pass;
    begin.framebuffer = framebuffer.handle();
    begin.renderArea = {{0, 0}, size};
    begin.clearValueCount = static_cast<std::uint32_t>(clear.size());
    begin.pClearValues = clear.data();
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

}  // namespace

glm::mat4 view_matrix(const FrameCamera& camera) {
    return glm::lookAt(camera.eye, camera.target, camera.up);
}

glm::vec3 project(const FrameCamera& camera, const glm::vec3& point, std::uint32_t width,
                  std::uint32_t height) {
    const glm::vec3 view(view_matrix(camera) * glm::vec4(point, 1));
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const float scale = 0.5F * h / std::tan(camera.vertical_angle / 2) / -view.z;
    return {0.5F * w * (1 + camera.centre.x) + scale * view.x,
            0.5F * h * (1 - camera.centre.y) - scale * view.y, -view.z};
}

Renderer::Renderer(GpuDevice& device)
    : device_(device),
      pipelines_(device),
      shapes_(device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
      vertices_(device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT),
      layers_(device) {}

Renderer::Targets Renderer::create_targets(VkExtent2D size) const {
    Targets targets;
    targets.size = size;
    targets.seen = Image(device_, size, seen_format,
                         VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                             VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                         VK_IMAGE_ASPECT_COLOR_BIT);
    targets.depth = Image(device_, size, depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                          VK_IMAGE_ASPECT_DEPTH_BIT);
    targets.colour = Image(device_, size, colour_format,
                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, drawn_format);
    const std::array shape_views{targets.seen.view(), targets.depth.view()};
    const std::array picture_views{targets.colour.view(), targets.depth.view()};
    targets.shapes = Framebuffer(device_, pipelines_.shape_pass, shape_views, size);
    targets.picture = Framebuffer(device_, pipelines_.picture_pass, picture_views, size);
    return targets;
}

bool Renderer::upload_shapes(VkCommandBuffer commands, const FrameScene& scene,
                             const glm::mat4& view) {
    const std::size_t count = scene.spheres.size() + scene.cones.size();
    const bool moved = shapes_.reserve(count * sizeof(GpuShape));
    std::byte* place = shapes_.mapped().data();
    picks_.clear();
    const auto add = [&](const auto& shape) {
        const GpuShape built = build_shape(view, shape);
        std::memcpy(place, &built, sizeof(built));
        place += sizeof(built);
        picks_.push_back(shape.pick);
    };
    for (const bool is_on_top : {false, true}) {
        for (const SphereShape& sphere : scene.spheres) {
            if (sphere.is_on_top == is_on_top) add(sphere);
        }
    }
    for (const bool is_on_top : {false, true}) {
        for (const ConeShape& cone : scene.cones) {
            if (cone.is_on_top == is_on_top) add(cone);
        }
    }
    shapes_.record(commands, count * sizeof(GpuShape));
    return moved;
}

bool Renderer::upload_meshes(VkCommandBuffer commands, VkExtent2D size) {
    picks_.insert(picks_.end(), meshes_.picks().begin(), meshes_.picks().end());
    const bool moved_vertices = upload(commands, vertices_, meshes_.vertices());
    const bool moved_layers = layers_.reserve(meshes_.has_translucent() ? size : VkExtent2D{0, 0});
    return moved_vertices || moved_layers;
}

void Renderer::check_size(VkExtent2D size) const {
    const std::uint32_t most = device_.limits().maxImageDimension2D;
    if (size.width == 0 || size.height == 0 || size.width > most || size.height > most) {
        throw GpuError(fmt::format("a picture of {}x{}; expected 1x1 to {}x{} on {}", size.width,
                                   size.height, most, most, device_.name()));
    }
}

void Renderer::record(VkCommandBuffer commands, const FrameScene& scene, VkExtent2D size) {
    check_size(size);
    record_frame(commands, scene, build_frame_constants(scene, size));
}

void Renderer::record_frame(VkCommandBuffer commands, const FrameScene& scene, GpuFrame constants) {
    const VkExtent2D size = size_of(constants);
    const glm::mat4 view = view_matrix(scene.camera);
    meshes_.build(scene, view, constants);
    const bool resized = size.width != targets_.size.width || size.height != targets_.size.height;
    if (resized) targets_ = create_targets(size);
    const bool moved_shapes = upload_shapes(commands, scene, view);
    const bool moved_meshes = upload_meshes(commands, size);
    constants.layer_room = layers_.room();
    if (moved_shapes || moved_meshes || resized) {
        pipelines_.write_descriptors(
            {shapes_.handle(), vertices_.handle(), layers_.handle(), targets_.seen.view()});
    }

    const VkViewport viewport{0, 0, static_cast<float>(size.width), static_cast<float>(size.height),
                              0, 1};
    const VkRect2D area{{0, 0}, size};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
    vkCmdPushConstants(commands, pipelines_.layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof(constants), &constants);
    if (meshes_.has_translucent()) layers_.record_clear(commands);
    record_shapes(commands, scene);
    if (meshes_.has_translucent()) layers_.record_drawn(commands);
    record_picture(commands, scene);
    if (meshes_.has_translucent()) record_nearest_layers(commands);
}

void Renderer::record_shapes(VkCommandBuffer commands, const FrameScene& scene) const {
    std::array<VkClearValue, 2> clear{};
    clear[0].color.uint32[1] = std::bit_cast<std::uint32_t>(nowhere);
    clear[1].depthStencil = {1, 0};
    begin_pass(commands, pipelines_.shape_pass, targets_.shapes, targets_.size, clear);
    // The shapes' pass must not bind what it draws into, but its set names those images; they are
    // in the layout that the set promises only afterwards, and no shader reads them here.
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_.layout, 0, 1,
                            &pipelines_.set, 0, nullptr);
    draw_vertices(commands, pipelines_.spheres, 6 * scene.spheres.size());
    draw_vertices(commands, pipelines_.cones, 6 * scene.cones.size());
    draw_triangles(commands, pipelines_.triangles, meshes_.opaque_inside());
    draw_triangles(commands, pipelines_.triangles, meshes_.opaque_across());
    // Last, when depth has all that hides them.
    draw_triangles(commands, pipelines_.layers, meshes_.translucent_inside());
    draw_triangles(commands, pipelines_.layers, meshes_.translucent_across());
    vkCmdEndRenderPass(commands);
}

void Renderer::draw_triangles(VkCommandBuffer commands, VkPipeline pipeline,
                              const TriangleRange& range) const {
    if (range.count == 0) return;
    const VkBuffer vertices = vertices_.handle();
    const VkDeviceSize start = 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &start);
    vkCmdDraw(commands, static_cast<std::uint32_t>(3 * range.count), 1,
              static_cast<std::uint32_t>(3 * range.first), 0);
}

void Renderer::record_picture(VkCommandBuffer commands, const FrameScene& scene) const {
    std::array<VkClearValue, 1> clear{};
    if (!scene.clear_background) {
        clear[0].color = {{scene.background.r, scene.background.g, scene.background.b, 1}};
    }
    begin_pass(commands, pipelines_.picture_pass, targets_.picture, targets_.size, clear);
    draw_vertices(commands, meshes_.has_opaque() ? pipelines_.shade_meshes : pipelines_.shade, 3);
    draw_vertices(commands, pipelines_.outline, 3);
    if (meshes_.has_translucent()) draw_vertices(commands, pipelines_.compose, 3);
    vkCmdEndRenderPass(commands);
}

void Renderer::record_nearest_layers(VkCommandBuffer commands) const {
    begin_pass(commands, pipelines_.again_pass, targets_.shapes, targets_.size, {});
    draw_vertices(commands, pipelines_.nearest, 3);
    vkCmdEndRenderPass(commands);
}

}  // namespace palpa
