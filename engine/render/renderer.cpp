#include "render/renderer.h"

#include "render/gpu_frame.h"
#include "render/sun.h"

#include <fmt/format.h>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace palpa {

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
      view_(device, pipelines_),
      sun_view_(device, pipelines_),
      layers_(device) {}

void Renderer::create_picture() {
    const VkExtent2D size = view_.size();
    colour_ = Image(device_, size, colour_format,
                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                    VK_IMAGE_ASPECT_COLOR_BIT, drawn_format);
    const std::array views{colour_.view(), view_.depth().view()};
    picture_ = Framebuffer(device_, pipelines_.picture_pass, views, size);
}

void Renderer::list_picks(const std::vector<SphereShape>& spheres,
                          const std::vector<ConeShape>& cones) {
    picks_.clear();
    const auto list = [&](const auto& shapes) {
        for (const bool is_on_top : {false, true}) {
            for (const auto& shape : shapes) {
                if (shape.is_on_top == is_on_top) picks_.push_back(shape.pick);
            }
        }
    };
    list(spheres);
    list(cones);
    picks_.insert(picks_.end(), view_.meshes().picks().begin(), view_.meshes().picks().end());
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

void Renderer::record_frame(VkCommandBuffer commands, const FrameScene& scene, GpuFrame frame) {
    constexpr std::size_t many = 20'000;  // to look at each costs less than to draw some of them
    const glm::mat4 view = view_matrix(scene.camera);
    const bool leaves_out =  // what is hidden may still cast shadows
        !scene.shadows && scene.spheres.size() + scene.cones.size() > many;
    if (leaves_out) drawn_.choose(scene, view, frame);
    const std::vector<SphereShape>& spheres = leaves_out ? drawn_.spheres() : scene.spheres;
    const std::vector<ConeShape>& cones = leaves_out ? drawn_.cones() : scene.cones;
    frame = count_shapes(frame, spheres, cones);
    const VkExtent2D before = view_.size();
    view_.upload(commands, scene.meshes, spheres, cones, view, frame);
    if (before.width != view_.size().width || before.height != view_.size().height) {
        create_picture();
    }
    list_picks(spheres, cones);
    const bool has_layers = view_.meshes().has_translucent();
    layers_.reserve(has_layers ? view_.size() : VkExtent2D{0, 0});
    frame.layer_room = layers_.room();
    if (scene.shadows) {
        frame.sun = find_sun(scene, view);
        record_sun(commands, scene, view, frame);
    }
    const Image& sun_seen = scene.shadows ? sun_view_.seen() : view_.seen();
    pipelines_.write_descriptors(
        pipelines_.set,
        {view_.shapes(), view_.vertices(), layers_.handle(), view_.seen().view(), sun_seen.view()});
    if (has_layers) layers_.record_clear(commands);
    view_.begin(commands, pipelines_.set, frame);
    view_.draw_opaque(commands, spheres.size(), cones.size());
    view_.draw_layers(commands);  // last, when depth has all that hides them
    vkCmdEndRenderPass(commands);
    if (has_layers) layers_.record_drawn(commands);
    record_picture(commands, scene);
    if (has_layers) record_nearest_layers(commands);
}

// How far everything is that the light falls on; not what is on top, which belongs to no place.
void Renderer::record_sun(VkCommandBuffer commands, const FrameScene& scene, const glm::mat4& view,
                          const GpuFrame& frame) {
    const GpuFrame from_sun = build_sun_frame(frame);
    sun_view_.upload(commands, scene.meshes, scene.spheres, scene.cones,
                     sun_matrix(frame.sun) * view, from_sun);
    pipelines_.write_descriptors(pipelines_.sun_set,
                                 {sun_view_.shapes(), sun_view_.vertices(), layers_.handle(),
                                  sun_view_.seen().view(), sun_view_.seen().view()});
    sun_view_.begin(commands, pipelines_.sun_set, from_sun);
    sun_view_.draw_opaque(commands, frame.last_sphere_below, frame.last_cone_below - frame.spheres);
    vkCmdEndRenderPass(commands);
}

void Renderer::record_picture(VkCommandBuffer commands, const FrameScene& scene) const {
    std::array<VkClearValue, 1> clear{};
    if (!scene.clear_background) {
        clear[0].color = {{scene.background.r, scene.background.g, scene.background.b, 1}};
    }
    begin_pass(commands, pipelines_.picture_pass, picture_, view_.size(), clear);
    draw_vertices(commands,
                  scene.shadows                 ? pipelines_.shade_all
                  : view_.meshes().has_opaque() ? pipelines_.shade_meshes
                                                : pipelines_.shade,
                  3);
    draw_vertices(commands, pipelines_.outline, 3);
    if (view_.meshes().has_translucent()) draw_vertices(commands, pipelines_.compose, 3);
    vkCmdEndRenderPass(commands);
}

void Renderer::record_nearest_layers(VkCommandBuffer commands) const {
    begin_pass(commands, pipelines_.again_pass, view_.framebuffer(), view_.size(), {});
    draw_vertices(commands, pipelines_.nearest, 3);
    vkCmdEndRenderPass(commands);
}

}  // namespace palpa
