#include "render/renderer.h"

#include "shaders/cone_frag.h"
#include "shaders/cone_vert.h"
#include "shaders/outline_frag.h"
#include "shaders/resolve_frag.h"
#include "shaders/resolve_vert.h"
#include "shaders/sphere_frag.h"
#include "shaders/sphere_vert.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr VkFormat seen_format = VK_FORMAT_R32G32_UINT, depth_format = VK_FORMAT_D32_SFLOAT,
                   colour_format = VK_FORMAT_R8G8B8A8_UNORM, drawn_format = VK_FORMAT_R8G8B8A8_SRGB;

// The layouts of shaders/frame.glsl.
struct GpuShape {
    glm::vec4 start, axis, paint_a, paint_b;
};
struct GpuFrame {
    glm::vec4 projection, size, fog;
    std::uint32_t spheres;
    std::int32_t outline, taps;
    float fog_from;
    glm::vec2 centre;
    std::uint32_t last_sphere_below, last_cone_below;
};
static_assert(sizeof(GpuFrame) <= 128, "push constants");
constexpr std::int32_t occlusion_taps = 8;  // all of the shader's
// What the shapes' pass leaves of a pixel.
struct Seen {
    std::uint32_t id;  // of a shape from 1, 0 where nothing is
    float distance;    // in front of the camera
};
constexpr float nowhere =
    1e9F;  // the distance of nothing, for shaders: a number that they can reckon with

// Shapes are numbered from 1, those on top last of their kind.
struct ShapeNumbers {
    std::uint32_t last_sphere_below, last_cone_below;
};

ShapeNumbers number_shapes(const FrameScene& scene) {
    const auto below = [](const auto& shapes) {
        return static_cast<std::uint32_t>(
            std::ranges::count_if(shapes, [](const auto& shape) { return !shape.is_on_top; }));
    };
    const auto spheres = static_cast<std::uint32_t>(scene.spheres.size());
    return {below(scene.spheres), spheres + below(scene.cones)};
}

GpuFrame build_frame_constants(const FrameScene& scene, VkExtent2D size) {
    const ShapeNumbers ids = number_shapes(scene);
    const FrameCamera& camera = scene.camera;
    const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
    const float y_scale = 1 / std::tan(camera.vertical_angle / 2);
    return {{y_scale * height / width, y_scale, camera.near, camera.far},
            {width, height, 1 / width, 1 / height},
            {scene.background, camera.fog_length > 0 ? 1 / camera.fog_length : 0},
            static_cast<std::uint32_t>(scene.spheres.size()),
            scene.outline,
            scene.occlusion ? occlusion_taps : 0,
            camera.fog_from,
            camera.centre,
            ids.last_sphere_below,
            ids.last_cone_below};
}

GpuShape build_shape(const glm::mat4& view, const SphereShape& sphere) {
    const glm::vec3 centre(view * glm::vec4(sphere.centre, 1));
    return {{centre, sphere.radius}, {0, 0, 0, 0}, {sphere.colour, 0}, {sphere.colour, 0}};
}

GpuShape build_shape(const glm::mat4& view, const ConeShape& cone) {
    const glm::vec3 a(view * glm::vec4(cone.a, 1)), b(view * glm::vec4(cone.b, 1));
    const float height = std::max(glm::length(b - a), 1e-6F);  // both ends at one place: nothing
    return {{a, cone.radius_a},
            {(b - a) / height, height},
            {cone.colour_a, (cone.radius_b - cone.radius_a) / height},
            {cone.colour_b, 0}};
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
                         VkPipelineStageFlags next_stage, VkAccessFlags next_access) {
    const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &colour;
    subpass.pDepthStencilAttachment = &depth;
    // What reads the attachments afterwards waits for them.
    VkSubpassDependency after{};
    after.srcSubpass = 0;
    after.dstSubpass = VK_SUBPASS_EXTERNAL;
    after.srcStageMask =
        VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    after.srcAccessMask =
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
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

// Part of a colour image, brought to the processor. The image is where it can be copied from.
class Readback {
public:
    Readback(const GpuDevice& device, VkExtent2D size, VkDeviceSize bytes_a_pixel)
        : size_(size),
          buffer_(device, bytes_a_pixel * size.width * size.height,
                  VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::Readback) {}

    void record(VkCommandBuffer commands, VkImage image, VkOffset2D from) const {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageOffset = {from.x, from.y, 0};
        region.imageExtent = {size_.width, size_.height, 1};
        vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               buffer_.handle(), 1, &region);
    }

    template <class Pixel>
    std::vector<Pixel> read() const {
        const std::span<std::byte> bytes = buffer_.mapped();
        std::vector<Pixel> pixels(bytes.size() / sizeof(Pixel));
        std::memcpy(pixels.data(), bytes.data(), bytes.size());
        return pixels;
    }

private:
    VkExtent2D size_;
    Buffer buffer_;
};

// The same for an image that shaders read before and afterwards.
void record_between_reads(VkCommandBuffer commands, VkImage image, VkOffset2D from,
                          const Readback& readback) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    readback.record(commands, image, from);
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    std::swap(barrier.oldLayout, barrier.newLayout);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                         &barrier);
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
    : device_(device), shapes_(device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
    create_passes();
    create_pipelines();
}

Renderer::~Renderer() {
    const VkDevice device = device_.handle();
    for (const VkPipeline pipeline : {draw_spheres_, draw_cones_, shade_, outline_}) {
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
    const VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    const std::array shapes{attachment(seen_format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
                            attachment(depth_format, depth_layout)};
    shape_pass_ = create_pass(
        device_.handle(), shapes,
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT,
        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT);
    std::array picture{attachment(drawn_format, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
                       attachment(depth_format, depth_layout)};
    picture[1].initialLayout = depth_layout;
    picture[1].loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    picture[1].storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    resolve_pass_ = create_pass(device_.handle(), picture, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                VK_ACCESS_TRANSFER_READ_BIT);
}

void Renderer::create_pipelines() {
    const VkDevice device = device_.handle();
    VkSamplerCreateInfo sampler{};
    sampler.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW =
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    check_vulkan(vkCreateSampler(device, &sampler, nullptr, &sampler_), "vkCreateSampler");

    std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
    for (std::uint32_t i = 0; i < bindings.size(); ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType =
            i < 1 ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    }
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    set_info.pBindings = bindings.data();
    check_vulkan(vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set_layout_),
                 "vkCreateDescriptorSetLayout");

    const std::array sizes{VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
                           VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}};
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
                           VkCompareOp compare) {
        const VkShaderModule vertex = create_module(device, vertex_code);
        const VkShaderModule fragment = create_module(device, fragment_code);
        const VkPipeline pipeline = create_pipeline(vertex, fragment, pass, compare);
        vkDestroyShaderModule(device, vertex, nullptr);
        vkDestroyShaderModule(device, fragment, nullptr);
        return pipeline;
    };
    draw_spheres_ = build(sphere_vert, sphere_frag, shape_pass_, VK_COMPARE_OP_LESS);
    draw_cones_ = build(cone_vert, cone_frag, shape_pass_, VK_COMPARE_OP_LESS);
    // At the far plane, where shapes are, and where nothing is: the depth test chooses the pixels.
    shade_ = build(resolve_vert, resolve_frag, resolve_pass_, VK_COMPARE_OP_GREATER);
    outline_ = build(resolve_vert, outline_frag, resolve_pass_, VK_COMPARE_OP_EQUAL);
}

VkPipeline Renderer::create_pipeline(VkShaderModule vertex, VkShaderModule fragment,
                                     VkRenderPass pass, VkCompareOp compare) const {
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
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
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
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = pass == shape_pass_ ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = compare;
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
    targets.shapes = Framebuffer(device_, shape_pass_, shape_views, size);
    targets.picture = Framebuffer(device_, resolve_pass_, picture_views, size);
    return targets;
}

void Renderer::write_descriptors() const {
    const VkDescriptorBufferInfo shapes{shapes_.handle(), 0, VK_WHOLE_SIZE};
    const VkDescriptorImageInfo seen{sampler_, targets_.seen.view(),
                                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    std::array<VkWriteDescriptorSet, 2> writes{};
    writes[0].sType = writes[1].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[0].dstSet = writes[1].dstSet = set_;
    writes[0].descriptorCount = writes[1].descriptorCount = 1;
    writes[0].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[0].pBufferInfo = &shapes;
    writes[1].dstBinding = 1;
    writes[1].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[1].pImageInfo = &seen;
    vkUpdateDescriptorSets(device_.handle(), static_cast<std::uint32_t>(writes.size()),
                           writes.data(), 0, nullptr);
}

bool Renderer::upload_shapes(VkCommandBuffer commands, const FrameScene& scene) {
    const std::size_t count = scene.spheres.size() + scene.cones.size();
    const bool moved = shapes_.reserve(count * sizeof(GpuShape));
    const glm::mat4 view = view_matrix(scene.camera);
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

void Renderer::check_size(VkExtent2D size) const {
    const std::uint32_t most = device_.limits().maxImageDimension2D;
    if (size.width == 0 || size.height == 0 || size.width > most || size.height > most) {
        throw GpuError(fmt::format("a picture of {}x{}; expected 1x1 to {}x{} on {}", size.width,
                                   size.height, most, most, device_.name()));
    }
}

void Renderer::record(VkCommandBuffer commands, const FrameScene& scene, VkExtent2D size) {
    check_size(size);
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
    clear[0].color.uint32[1] = std::bit_cast<std::uint32_t>(nowhere);
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
    const auto draw = [&](VkPipeline pipeline, std::size_t vertices) {
        if (vertices == 0) return;
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
        vkCmdDraw(commands, static_cast<std::uint32_t>(vertices), 1, 0, 0);
    };
    draw(draw_spheres_, 6 * scene.spheres.size());
    draw(draw_cones_, 6 * scene.cones.size());
    vkCmdEndRenderPass(commands);

    begin.renderPass = resolve_pass_;
    begin.framebuffer = targets_.picture.handle();
    clear[0].color = {{scene.background.r, scene.background.g, scene.background.b, 1}};
    begin.clearValueCount = 1;
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    draw(shade_, 3);
    draw(outline_, 3);
    vkCmdEndRenderPass(commands);
}

Picture Renderer::draw(const FrameScene& scene, std::uint32_t width, std::uint32_t height,
                       PictureContent content) {
    const VkExtent2D size{width, height};
    check_size(size);
    const Readback colours(device_, size, 4);
    std::optional<Readback> seen;
    if (content == PictureContent::All) seen.emplace(device_, size, sizeof(Seen));
    device_.submit([&](VkCommandBuffer commands) {
        record(commands, scene, size);
        colours.record(commands, targets_.colour.handle(), {0, 0});
        if (seen) record_between_reads(commands, targets_.seen.handle(), {0, 0}, *seen);
        show_copies_to_host(commands);
    });
    Picture picture{width, height, colours.read<std::uint8_t>(), {}, {}};
    if (!seen) return picture;
    for (const Seen& pixel : seen->read<Seen>()) {
        picture.picks.push_back(pick_of(pixel.id));
        picture.depth.push_back(pixel.id == 0 ? std::numeric_limits<float>::infinity()
                                              : pixel.distance);
    }
    return picture;
}

std::uint32_t Renderer::pick(std::uint32_t x, std::uint32_t y) {
    if (x >= targets_.size.width || y >= targets_.size.height) return Picture::nothing_seen;
    const Readback readback(device_, {1, 1}, sizeof(Seen));
    device_.submit([&](VkCommandBuffer commands) {
        record_between_reads(commands, targets_.seen.handle(),
                             {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                             readback);
        show_copies_to_host(commands);
    });
    return pick_of(readback.read<Seen>().front().id);
}

std::uint32_t Renderer::pick_of(std::uint32_t id) const noexcept {
    return id == 0 ? Picture::nothing_seen : picks_[id - 1];
}

}  // namespace palpa
