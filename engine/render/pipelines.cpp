#include "render/pipelines.h"

#include "render/gpu_frame.h"

#include "shaders/compose_frag.h"
#include "shaders/cone_frag.h"
#include "shaders/cone_vert.h"
#include "shaders/layers_frag.h"
#include "shaders/mesh_frag.h"
#include "shaders/mesh_vert.h"
#include "shaders/nearest_frag.h"
#include "shaders/outline_frag.h"
#include "shaders/resolve_frag.h"
#include "shaders/resolve_vert.h"
#include "shaders/sphere_frag.h"
#include "shaders/sphere_vert.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpa {
namespace {

constexpr VkShaderStageFlags both_stages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

// The bindings of a set: storage buffers, then the images of what is seen.
constexpr std::uint32_t storage_buffers = 3, sampled_images = 2,
                        bindings_in_all = storage_buffers + sampled_images;

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
    // And what draws into them again, for what read them or drew them before.
    VkSubpassDependency before{};
    before.srcSubpass = VK_SUBPASS_EXTERNAL;
    before.dstSubpass = 0;
    before.srcStageMask = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | after.srcStageMask;
    before.srcAccessMask = after.srcAccessMask;
    before.dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                          VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                          VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    before.dstAccessMask =
        VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
        VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const std::array dependencies{after, before};
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = static_cast<std::uint32_t>(dependencies.size());
    info.pDependencies = dependencies.data();
    VkRenderPass pass = VK_NULL_HANDLE;
    check_vulkan(vkCreateRenderPass(device, &info, nullptr, &pass), "vkCreateRenderPass");
    return pass;
}

}  // namespace

// What pipelines differ in.
struct Pipelines::Kind {
    VkRenderPass pass;
    VkCompareOp compare;
    bool writes_depth;
    bool has_vertices = false;                        // of triangles; else a shader makes them up
    bool shades_meshes = false, has_shadows = false;  // the constants 0 and 1 of resolve.frag
    bool writes_colour = true;
    bool blends = false;  // lays colours times their coverage over what is there
};

Pipelines::Pipelines(const GpuDevice& device)
    : Pipelines(device.handle()) {  // from here on the destructor runs, whatever is thrown
    create_passes();
    create_layout();
    create_sets();
    create_pipelines();
}

Pipelines::~Pipelines() {
    for (const VkPipeline pipeline : {spheres, cones, triangles, layers, shade, shade_meshes,
                                      shade_all, outline, compose, nearest}) {
        vkDestroyPipeline(device_, pipeline, nullptr);
    }
    vkDestroyPipelineLayout(device_, layout, nullptr);
    vkDestroyDescriptorPool(device_, descriptors_, nullptr);
    vkDestroyDescriptorSetLayout(device_, set_layout_, nullptr);
    vkDestroySampler(device_, sampler_, nullptr);
    vkDestroyRenderPass(device_, shape_pass, nullptr);
    vkDestroyRenderPass(device_, picture_pass, nullptr);
    vkDestroyRenderPass(device_, again_pass, nullptr);
}

void Pipelines::create_passes() {
    const VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    std::array shapes{attachment(seen_format, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL),
                      attachment(depth_format, depth_layout)};
    const VkPipelineStageFlags readers =
        VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT;
    const VkAccessFlags reads =
        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    shape_pass = create_pass(device_, shapes, readers, reads);
    for (VkAttachmentDescription& kept : shapes) {
        kept.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
        kept.initialLayout = kept.finalLayout;
    }
    again_pass = create_pass(device_, shapes, readers, reads);
    std::array picture{attachment(drawn_format, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
                       attachment(depth_format, depth_layout)};
    picture[1].initialLayout = depth_layout;
    picture[1].loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    picture_pass =
        create_pass(device_, picture, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
}

void Pipelines::create_layout() {
    VkSamplerCreateInfo sampler{};
    sampler.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW =
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    check_vulkan(vkCreateSampler(device_, &sampler, nullptr, &sampler_), "vkCreateSampler");

    std::array<VkDescriptorSetLayoutBinding, bindings_in_all> bindings{};
    for (std::uint32_t i = 0; i < bindings.size(); ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType = i < storage_buffers
                                         ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                         : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = both_stages;
    }
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    set_info.pBindings = bindings.data();
    check_vulkan(vkCreateDescriptorSetLayout(device_, &set_info, nullptr, &set_layout_),
                 "vkCreateDescriptorSetLayout");

    const VkPushConstantRange constants{both_stages, 0, sizeof(GpuFrame)};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = &set_layout_;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &constants;
    check_vulkan(vkCreatePipelineLayout(device_, &info, nullptr, &layout),
                 "vkCreatePipelineLayout");
}

void Pipelines::create_sets() {
    const std::array sizes{
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * storage_buffers},
        VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * sampled_images}};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 2;
    pool.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool.pPoolSizes = sizes.data();
    check_vulkan(vkCreateDescriptorPool(device_, &pool, nullptr, &descriptors_),
                 "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = descriptors_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout_;
    for (VkDescriptorSet* const one : {&set, &sun_set}) {
        check_vulkan(vkAllocateDescriptorSets(device_, &allocate, one), "vkAllocateDescriptorSets");
    }
}

void Pipelines::write_descriptors(VkDescriptorSet written, const FrameResources& resources) const {
    const std::array buffers{resources.shapes, resources.vertices, resources.layers};
    static_assert(buffers.size() == storage_buffers);
    const VkImageLayout readable = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const std::array<VkDescriptorImageInfo, sampled_images> images{
        {{sampler_, resources.seen, readable}, {sampler_, resources.sun_seen, readable}}};
    std::array<VkDescriptorBufferInfo, storage_buffers> wholes{};
    std::array<VkWriteDescriptorSet, bindings_in_all> writes{};
    for (std::uint32_t i = 0; i < writes.size(); ++i) {
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = written;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1;
        if (i < storage_buffers) {
            wholes[i] = {buffers[i], 0, VK_WHOLE_SIZE};
            writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
            writes[i].pBufferInfo = &wholes[i];
        } else {
            writes[i].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
            writes[i].pImageInfo = &images[i - storage_buffers];
        }
    }
    vkUpdateDescriptorSets(device_, static_cast<std::uint32_t>(writes.size()), writes.data(), 0,
                           nullptr);
}

void Pipelines::create_pipelines() {
    spheres = create_pipeline(sphere_vert, sphere_frag, {shape_pass, VK_COMPARE_OP_LESS, true});
    cones = create_pipeline(cone_vert, cone_frag, {shape_pass, VK_COMPARE_OP_LESS, true});
    triangles = create_pipeline(mesh_vert, mesh_frag,
                                {.pass = shape_pass,
                                 .compare = VK_COMPARE_OP_LESS,
                                 .writes_depth = true,
                                 .has_vertices = true});
    layers = create_pipeline(mesh_vert, layers_frag,
                             {.pass = shape_pass,
                              .compare = VK_COMPARE_OP_LESS,
                              .writes_depth = false,
                              .has_vertices = true,
                              .writes_colour = false});
    // At the far plane, where something is, and where nothing is: the depth test chooses the
    // pixels.
    shade =
        create_pipeline(resolve_vert, resolve_frag, {picture_pass, VK_COMPARE_OP_GREATER, false});
    shade_meshes = create_pipeline(resolve_vert, resolve_frag,
                                   {.pass = picture_pass,
                                    .compare = VK_COMPARE_OP_GREATER,
                                    .writes_depth = false,
                                    .shades_meshes = true});
    shade_all = create_pipeline(resolve_vert, resolve_frag,
                                {.pass = picture_pass,
                                 .compare = VK_COMPARE_OP_GREATER,
                                 .writes_depth = false,
                                 .shades_meshes = true,
                                 .has_shadows = true});
    outline =
        create_pipeline(resolve_vert, outline_frag, {picture_pass, VK_COMPARE_OP_EQUAL, false});
    compose = create_pipeline(resolve_vert, compose_frag,
                              {.pass = picture_pass,
                               .compare = VK_COMPARE_OP_ALWAYS,
                               .writes_depth = false,
                               .blends = true});
    nearest = create_pipeline(resolve_vert, nearest_frag, {again_pass, VK_COMPARE_OP_EQUAL, false});
}

VkPipeline Pipelines::create_pipeline(std::span<const std::uint32_t> vertex_code,
                                      std::span<const std::uint32_t> fragment_code,
                                      const Kind& kind) const {
    const std::array<VkBool32, 2> values{kind.shades_meshes ? VK_TRUE : VK_FALSE,
                                         kind.has_shadows ? VK_TRUE : VK_FALSE};
    const std::array entries{VkSpecializationMapEntry{0, 0, sizeof(VkBool32)},
                             VkSpecializationMapEntry{1, sizeof(VkBool32), sizeof(VkBool32)}};
    const VkSpecializationInfo constants{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                         sizeof(values), values.data()};
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    stages[0].sType = stages[1].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = create_module(device_, vertex_code);
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = create_module(device_, fragment_code);
    stages[1].pSpecializationInfo = &constants;
    stages[0].pName = stages[1].pName = "main";

    const VkVertexInputBindingDescription vertices{0, sizeof(GpuVertex),
                                                   VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription place{0, 0, VK_FORMAT_R32G32B32_SFLOAT,
                                                  offsetof(GpuVertex, place)};
    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    input.vertexBindingDescriptionCount = input.vertexAttributeDescriptionCount =
        kind.has_vertices ? 1 : 0;
    input.pVertexBindingDescriptions = &vertices;
    input.pVertexAttributeDescriptions = &place;
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
    depth.depthWriteEnable = kind.writes_depth ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = kind.compare;
    VkPipelineColorBlendAttachmentState write{};
    if (kind.writes_colour) {
        write.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                               VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    }
    write.blendEnable = kind.blends ? VK_TRUE : VK_FALSE;
    write.srcColorBlendFactor = write.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    write.dstColorBlendFactor = write.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
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
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout;
    info.renderPass = kind.pass;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult created =
        vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    for (const VkPipelineShaderStageCreateInfo& stage : stages) {
        vkDestroyShaderModule(device_, stage.module, nullptr);
    }
    check_vulkan(created, "vkCreateGraphicsPipelines");
    return pipeline;
}

}  // namespace palpa
