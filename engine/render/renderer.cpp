#include "render/renderer.h"

#include "shaders/cone_frag.h"
#include "shaders/cone_vert.h"
#include "shaders/resolve_frag.h"
#include "shaders/resolve_vert.h"
#include "shaders/sphere_frag.h"
#include "shaders/sphere_vert.h"

#include <fmt/format.h>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace palpa {
namespace {

constexpr VkFormat id_format = VK_FORMAT_R32_UINT, depth_format = VK_FORMAT_D32_SFLOAT,
                   colour_format = VK_FORMAT_R8G8B8A8_UNORM, drawn_format = VK_FORMAT_R8G8B8A8_SRGB;

// The layouts of shaders/frame.glsl.
struct GpuSphere {
    glm::vec4 centre_radius, colour;
};
struct GpuCone {
    glm::vec4 a_radius, b_radius, colour_a, colour_b;
};
struct GpuFrame {
    glm::mat4 view;
    glm::vec4 projection, background, size;
};
static_assert(sizeof(GpuFrame) <= 128, "push constants");

GpuFrame build_frame_constants(const FrameScene& scene, VkExtent2D size) {
    const FrameCamera& camera = scene.camera;
    const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
    const float y_scale = 1 / std::tan(camera.vertical_angle / 2);
    return {view_matrix(camera),
            {y_scale * height / width, y_scale, camera.near, camera.far},
            {scene.background, static_cast<float>(scene.spheres.size())},
            {width, height, 1 / width, 1 / height}};
}

VkShaderModule create_module(VkDevice device, std::span<const std::uint32_t> code) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    VkShaderModule shader = VK_NULL_HANDLE;
    check_vulkan(vkCreateShaderModule(device, &info, nullptr, &shader), "vkCreateShaderModule");
    return shader;
}

VkAttachmentDescription attachment(VkFormat format, VkImageLayout last) {
    VkAttachmentDescription description{};
    description.format = format;
    description.samples = VK_SAMPLE_COUNT_1_BIT;
    description.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    description.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    description.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    description.finalLayout = last;
    return description;
}

VkRenderPass create_pass(VkDevice device, std::span<const VkAttachmentDescription> attachments,
                         bool has_depth, VkPipelineStageFlags next_stage,
                         VkAccessFlags next_access) {
    const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &colour;
    subpass.pDepthStencilAttachment = has_depth ? &depth : nullptr;
    // What reads the attachments afterwards waits for them.
    VkSubpassDependency after{};
    after.srcSubpass = 0;
    after.dstSubpass = VK_SUBPASS_EXTERNAL;
    after.srcStageMask =
        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    after.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                          (has_depth ? VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT : 0);
    after.dstStageMask = next_stage;
    after.dstAccessMask = next_access;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = 1;
    info.pDependencies = &after;
    VkRenderPass pass = VK_NULL_HANDLE;
    check_vulkan(vkCreateRenderPass(device, &info, nullptr, &pass), "vkCreateRenderPass");
    return pass;
}

VkBufferImageCopy region_of(VkImageAspectFlags aspect, VkOffset2D from, VkExtent2D size) {
    VkBufferImageCopy region{};
    region.imageSubresource = {aspect, 0, 0, 1};
    region.imageOffset = {from.x, from.y, 0};
    region.imageExtent = {size.width, size.height, 1};
    return region;
}

// An image's picture elements of 4 bytes, brought to the processor.
class Readback {
public:
    Readback(const GpuDevice& device, VkExtent2D size)
        : buffer_(device, VkDeviceSize{4} * size.width * size.height,
                  VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback) {}

    void copy(VkCommandBuffer commands, VkImage image, const VkBufferImageCopy& region) const {
        vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               buffer_.handle(), 1, &region);
    }

    template <class T>
    std::vector<T> read() const {
        const std::span<std::byte> bytes = buffer_.mapped();
        std::vector<T> values(bytes.size() / sizeof(T));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

private:
    Buffer buffer_;
};

void change_layout(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                   VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, 1, 0, 1};
    const VkPipelineStageFlags reads =
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    vkCmdPipelineBarrier(commands, reads, reads, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

// From being read by a shader to being copied, and back.
void copy_readable(VkCommandBuffer commands, VkImage image, const Readback& target,
                   const VkBufferImageCopy& region) {
    const VkImageAspectFlags aspect = region.imageSubresource.aspectMask;
    change_layout(commands, image, aspect, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    target.copy(commands, image, region);
    change_layout(commands, image, aspect, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
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
    return {0.5F * w + scale * view.x, 0.5F * h - scale * view.y, -view.z};
}

Renderer::Renderer(GpuDevice& device)
    : device_(device),
      sphere_buffer_(device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
      cone_buffer_(device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
    create_passes();
    create_pipelines();
}

Renderer::~Renderer() {
    const VkDevice device = device_.handle();
    for (const VkPipeline pipeline : {spheres_, cones_, resolve_}) {
        vkDestroyPipeline(device, pipeline, nullptr);
    }
    vkDestroyPipelineLayout(device, layout_, nullptr);
    vkDestroyDescriptorPool(device, descriptors_, nullptr);
    vkDestroyDescriptorSetLayout(device, set_layout_, nullptr);
    vkDestroySampler(device, sampler_, nullptr);
    vkDestroyRenderPass(device, shape_pass_, nullptr);
    vkDestroyRenderPass(device, resolve_pass_, nullptr);
}

void Renderer::create_passes() {
    const std::array shapes{attachment(id_format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
                            attachment(depth_format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)};
    shape_pass_ = create_pass(device_.handle(), shapes, true, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                              VK_ACCESS_SHADER_READ_BIT);
    const std::array picture{attachment(drawn_format, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)};
    resolve_pass_ = create_pass(device_.handle(), picture, false, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                VK_ACCESS_TRANSFER_READ_BIT);
}

void Renderer::create_pipelines() {
    const VkDevice device = device_.handle();
    VkSamplerCreateInfo sampler{};
    sampler.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW =
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    check_vulkan(vkCreateSampler(device, &sampler, nullptr, &sampler_), "vkCreateSampler");

    std::array<VkDescriptorSetLayoutBinding, 4> bindings{};
    for (std::uint32_t i = 0; i < bindings.size(); ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType =
            i < 2 ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    }
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    set_info.pBindings = bindings.data();
    check_vulkan(vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set_layout_),
                 "vkCreateDescriptorSetLayout");

    const std::array sizes{VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2},
                           VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2}};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool.pPoolSizes = sizes.data();
    check_vulkan(vkCreateDescriptorPool(device, &pool, nullptr, &descriptors_),
                 "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = descriptors_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout_;
    check_vulkan(vkAllocateDescriptorSets(device, &allocate, &set_), "vkAllocateDescriptorSets");

    const VkPushConstantRange constants{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                                        0, sizeof(GpuFrame)};
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout_;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &constants;
    check_vulkan(vkCreatePipelineLayout(device, &layout, nullptr, &layout_),
                 "vkCreatePipelineLayout");

    const auto build = [&](std::span<const std::uint32_t> vertex_code,
                           std::span<const std::uint32_t> fragment_code, VkRenderPass pass,
                           bool has_depth) {
        const VkShaderModule vertex = create_module(device, vertex_code);
        const VkShaderModule fragment = create_module(device, fragment_code);
        const VkPipeline pipeline = create_pipeline(vertex, fragment, pass, has_depth);
        vkDestroyShaderModule(device, vertex, nullptr);
        vkDestroyShaderModule(device, fragment, nullptr);
        return pipeline;
    };
    spheres_ = build(sphere_vert, sphere_frag, shape_pass_, true);
    cones_ = build(cone_vert, cone_frag, shape_pass_, true);
    resolve_ = build(resolve_vert, resolve_frag, resolve_pass_, false);
}

VkPipeline Renderer::create_pipeline(VkShaderModule vertex, VkShaderModule fragment,
                                     VkRenderPass pass, bool has_depth) const {
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    stages[0].sType = stages[1].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = vertex;
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = fragment;
    stages[0].pName = stages[1].pName = "main";

    VkPipelineVertexInputStateCreateInfo no_input{};
    no_input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{};
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = depth.depthWriteEnable = has_depth ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = VK_COMPARE_OP_LESS;
    VkPipelineColorBlendAttachmentState write{};
    write.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                           VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = 1;
    blend.pAttachments = &write;
    const std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamic_states.size());
    dynamic.pDynamicStates = dynamic_states.data();

    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &no_input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout_;
    info.renderPass = pass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check_vulkan(
        vkCreateGraphicsPipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines");
    return pipeline;
}

Renderer::Targets Renderer::create_targets(VkExtent2D size) const {
    const VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    Targets targets;
    targets.size = size;
    targets.ids = Image(device_, size, id_format, read | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                        VK_IMAGE_ASPECT_COLOR_BIT);
    targets.depth =
        Image(device_, size, depth_format, read | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
              VK_IMAGE_ASPECT_DEPTH_BIT);
    targets.colour = Image(device_, size, colour_format,
                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                           VK_IMAGE_ASPECT_COLOR_BIT, drawn_format);
    const std::array shape_views{targets.ids.view(), targets.depth.view()};
    const std::array picture_views{targets.colour.view()};
    targets.shapes = Framebuffer(device_, shape_pass_, shape_views, size);
    targets.picture = Framebuffer(device_, resolve_pass_, picture_views, size);
    return targets;
}

void Renderer::write_descriptors() const {
    const std::array<VkDescriptorBufferInfo, 2> buffers{
        {{sphere_buffer_.handle(), 0, VK_WHOLE_SIZE}, {cone_buffer_.handle(), 0, VK_WHOLE_SIZE}}};
    const std::array<VkDescriptorImageInfo, 2> images{
        {{sampler_, targets_.ids.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
         {sampler_, targets_.depth.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}}};
    std::array<VkWriteDescriptorSet, 2> writes{};
    writes[0].sType = writes[1].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[0].dstSet = writes[1].dstSet = set_;
    writes[0].descriptorCount = writes[1].descriptorCount = 2;
    writes[0].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[0].pBufferInfo = buffers.data();
    writes[1].dstBinding = 2;
    writes[1].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[1].pImageInfo = images.data();
    vkUpdateDescriptorSets(device_.handle(), static_cast<std::uint32_t>(writes.size()),
                           writes.data(), 0, nullptr);
}

bool Renderer::upload_shapes(VkCommandBuffer commands, const FrameScene& scene) {
    const bool spheres_moved = sphere_buffer_.reserve(scene.spheres.size() * sizeof(GpuSphere));
    const bool cones_moved = cone_buffer_.reserve(scene.cones.size() * sizeof(GpuCone));
    picks_.clear();
    std::byte* place = sphere_buffer_.mapped().data();
    for (const SphereShape& s : scene.spheres) {
        const GpuSphere sphere{{s.centre, s.radius}, {s.colour, 1}};
        std::memcpy(place, &sphere, sizeof(sphere));
        place += sizeof(sphere);
        picks_.push_back(s.pick);
    }
    place = cone_buffer_.mapped().data();
    for (const ConeShape& c : scene.cones) {
        const GpuCone cone{{c.a, c.radius_a}, {c.b, c.radius_b}, {c.colour_a, 1}, {c.colour_b, 1}};
        std::memcpy(place, &cone, sizeof(cone));
        place += sizeof(cone);
        picks_.push_back(c.pick);
    }
    sphere_buffer_.record(commands, scene.spheres.size() * sizeof(GpuSphere));
    cone_buffer_.record(commands, scene.cones.size() * sizeof(GpuCone));
    return spheres_moved || cones_moved;
}

void Renderer::record(VkCommandBuffer commands, const FrameScene& scene, VkExtent2D size) {
    const std::uint32_t most = device_.limits().maxImageDimension2D;
    if (size.width == 0 || size.height == 0 || size.width > most || size.height > most) {
        throw GpuError(fmt::format("a picture of {}x{}; expected 1x1 to {}x{} on {}", size.width,
                                   size.height, most, most, device_.name()));
    }
    const bool resized = size.width != targets_.size.width || size.height != targets_.size.height;
    if (resized) targets_ = create_targets(size);
    if (upload_shapes(commands, scene) || resized) write_descriptors();

    const VkViewport viewport{0, 0, static_cast<float>(size.width), static_cast<float>(size.height),
                              0, 1};
    const VkRect2D area{{0, 0}, size};
    const GpuFrame constants = build_frame_constants(scene, size);
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &area);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
                       0, sizeof(constants), &constants);

    std::array<VkClearValue, 2> clear{};
    clear[1].depthStencil = {1, 0};
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = shape_pass_;
    begin.framebuffer = targets_.shapes.handle();
    begin.renderArea = area;
    begin.clearValueCount = static_cast<std::uint32_t>(clear.size());
    begin.pClearValues = clear.data();
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    // The shapes' pass must not bind what it draws into, but its set names those images; they are
    // in the layout that the set promises only afterwards, and no shader reads them here.
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_, 0,
                            nullptr);
    if (!scene.spheres.empty()) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, spheres_);
        vkCmdDraw(commands, 4, static_cast<std::uint32_t>(scene.spheres.size()), 0, 0);
    }
    if (!scene.cones.empty()) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, cones_);
        vkCmdDraw(commands, 14, static_cast<std::uint32_t>(scene.cones.size()), 0, 0);
    }
    vkCmdEndRenderPass(commands);

    begin.renderPass = resolve_pass_;
    begin.framebuffer = targets_.picture.handle();
    begin.clearValueCount = 1;
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, resolve_);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRenderPass(commands);
}

Picture Renderer::draw(const FrameScene& scene, std::uint32_t width, std::uint32_t height,
                       PictureContent content) {
    const VkExtent2D size{width, height};
    std::optional<Readback> colours, ids, depths;
    device_.submit([&](VkCommandBuffer commands) {
        record(commands, scene, size);
        colours.emplace(device_, size);
        colours->copy(commands, targets_.colour.handle(),
                      region_of(VK_IMAGE_ASPECT_COLOR_BIT, {0, 0}, size));
        if (content == PictureContent::All) {
            ids.emplace(device_, size);
            copy_readable(commands, targets_.ids.handle(), *ids,
                          region_of(VK_IMAGE_ASPECT_COLOR_BIT, {0, 0}, size));
            depths.emplace(device_, size);
            copy_readable(commands, targets_.depth.handle(), *depths,
                          region_of(VK_IMAGE_ASPECT_DEPTH_BIT, {0, 0}, size));
        }
        show_copies_to_host(commands);
    });
    Picture picture{width, height, colours->read<std::uint8_t>(), {}, {}};
    if (content == PictureContent::Colours) return picture;
    picture.picks = ids->read<std::uint32_t>();
    picture.depth = depths->read<float>();
    const float near = scene.camera.near, far = scene.camera.far;
    for (std::size_t i = 0; i < picture.picks.size(); ++i) {
        picture.depth[i] = picture.picks[i] == 0
                               ? std::numeric_limits<float>::infinity()
                               : far * near / (far - picture.depth[i] * (far - near));
        picture.picks[i] = pick_of(picture.picks[i]);
    }
    return picture;
}

std::uint32_t Renderer::pick(std::uint32_t x, std::uint32_t y) {
    if (x >= targets_.size.width || y >= targets_.size.height) return Picture::nothing_seen;
    const Readback id(device_, {1, 1});
    const VkOffset2D pixel{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
    device_.submit([&](VkCommandBuffer commands) {
        copy_readable(commands, targets_.ids.handle(), id,
                      region_of(VK_IMAGE_ASPECT_COLOR_BIT, pixel, {1, 1}));
        show_copies_to_host(commands);
    });
    return pick_of(id.read<std::uint32_t>().front());
}

std::uint32_t Renderer::pick_of(std::uint32_t id) const noexcept {
    return id == 0 ? Picture::nothing_seen : picks_[id - 1];
}

}  // namespace palpa
