#include "render/shape_view.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <vector>

namespace palpa {
namespace {

template <class Element>
void write_buffer(VkCommandBuffer commands, UploadBuffer& buffer,
                  const std::vector<Element>& elements) {
    const std::size_t bytes = elements.size() * sizeof(Element);
    (void)buffer.reserve(bytes);  // descriptors are written for every frame
    if (bytes > 0) std::memcpy(buffer.mapped().data(), elements.data(), bytes);
    buffer.record(commands, bytes);
}

}  // namespace

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

ShapeView::ShapeView(const GpuDevice& device, const Pipelines& pipelines)
    : device_(&device),
      pipelines_(&pipelines),
      shapes_(device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
      vertices_(device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT) {}

void ShapeView::upload(VkCommandBuffer commands, const std::vector<MeshShape>& meshes,
                       const std::vector<SphereShape>& spheres, const std::vector<ConeShape>& cones,
                       const glm::mat4& view, const GpuFrame& frame) {
    meshes_.build(meshes, view, frame);
    const VkExtent2D size = size_of(frame);
    if (size.width != size_.width || size.height != size_.height) create_images(size);
    upload_shapes(commands, spheres, cones, view);
    write_buffer(commands, vertices_, meshes_.vertices());
}

void ShapeView::create_images(VkExtent2D size) {
    seen_ = Image(*device_, size, seen_format,
                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                      VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                  VK_IMAGE_ASPECT_COLOR_BIT);
    depth_ = Image(*device_, size, depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                   VK_IMAGE_ASPECT_DEPTH_BIT);
    const std::array views{seen_.view(), depth_.view()};
    framebuffer_ = Framebuffer(*device_, pipelines_->shape_pass, views, size);
    size_ = size;
}

void ShapeView::upload_shapes(VkCommandBuffer commands, const std::vector<SphereShape>& spheres,
                              const std::vector<ConeShape>& cones, const glm::mat4& view) {
    const std::size_t count = spheres.size() + cones.size();
    (void)shapes_.reserve(count * sizeof(GpuShape));
    std::byte* place = shapes_.mapped().data();
    const auto add = [&](const auto& shape) {
        const GpuShape built = build_shape(view, shape);
        std::memcpy(place, &built, sizeof(built));
        place += sizeof(built);
    };
    for (const bool is_on_top : {false, true}) {
        for (const SphereShape& sphere : spheres) {
            if (sphere.is_on_top == is_on_top) add(sphere);
        }
    }
    for (const bool is_on_top : {false, true}) {
        for (const ConeShape& cone : cones) {
            if (cone.is_on_top == is_on_top) add(cone);
        }
    }
    shapes_.record(commands, count * sizeof(GpuShape));
}

void ShapeView::begin(VkCommandBuffer commands, VkDescriptorSet set, const GpuFrame& frame) const {
    const VkViewport viewport{
        0, 0, static_cast<float>(size_.width), static_cast<float>(size_.height), 0, 1};
    const VkRect2D area{{0, 0}, size_};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
    vkCmdPushConstants(commands, pipelines_->layout,
                       VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(frame),
                       &frame);
    std::array<VkClearValue, 2> clear{};
    clear[0].color.uint32[1] = std::bit_cast<std::uint32_t>(nowhere);
    clear[1].depthStencil = {1, 0};
    begin_pass(commands, pipelines_->shape_pass, framebuffer_, size_, clear);
    // The shapes' pass must not bind what it draws into, but its set names those images; they are
    // in the layout that the set promises only afterwards, and no shader reads them here.
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_->layout, 0, 1,
                            &set, 0, nullptr);
}

void ShapeView::draw_opaque(VkCommandBuffer commands, std::size_t spheres,
                            std::size_t cones) const {
    draw_vertices(commands, pipelines_->spheres, 6 * spheres);
    draw_vertices(commands, pipelines_->cones, 6 * cones);
    draw_triangles(commands, pipelines_->triangles, meshes_.opaque_inside());
    draw_triangles(commands, pipelines_->triangles, meshes_.opaque_across());
}

void ShapeView::draw_layers(VkCommandBuffer commands) const {
    draw_triangles(commands, pipelines_->layers, meshes_.translucent_inside());
    draw_triangles(commands, pipelines_->layers, meshes_.translucent_across());
}

void ShapeView::draw_triangles(VkCommandBuffer commands, VkPipeline pipeline,
                               const TriangleRange& range) const {
    if (range.count == 0) return;
    const VkBuffer vertices = vertices_.handle();
    const VkDeviceSize start = 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &start);
    vkCmdDraw(commands, static_cast<std::uint32_t>(3 * range.count), 1,
              static_cast<std::uint32_t>(3 * range.first), 0);
}

}  // namespace palpa
