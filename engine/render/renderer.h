// Draws a FrameScene without a window: spheres and cones as impostors, and meshes, deferred.
#pragma once
#include "gpu/device.h"
#include "gpu/resources.h"
#include "render/drawn_shapes.h"
#include "render/frame_scene.h"
#include "render/gpu_frame.h"
#include "render/layer_lists.h"
#include "render/picture.h"
#include "render/pipelines.h"
#include "render/shape_view.h"

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace palpa {

// Two passes. The first finds for every pixel which shape or triangle is nearest and how far; the
// second shades each pixel that shows one: light from the camera's upper left, ambient occlusion
// from eight taps of the distances around or more, a dark outline where distance breaks off, fog in
// the distance. What is translucent goes into lists of layers, a list a pixel, in the first pass,
// and is sorted and laid over the opaque picture in the second.
class Renderer {
public:
    // Throws GpuError.
    explicit Renderer(GpuDevice& device);
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer() = default;

    // Throws GpuError if the size is 0 or beyond what the device can do in one piece.
    void check_size(VkExtent2D size) const;

    // Draws, waits, and brings back what is wanted of the picture, drawn in tiles where it is
    // beyond what the device can do in one piece. Throws GpuError if the size is 0, a mesh has an
    // index of no vertex, or there are more translucent layers than the device has room for.
    Picture draw(const FrameScene& scene, std::uint32_t width, std::uint32_t height,
                 PictureContent content = PictureContent::All);

    // The same in tiles of `largest` pixels a side at most; `pick` then knows only the last of
    // them.
    Picture draw_in_tiles(const FrameScene& scene, std::uint32_t width, std::uint32_t height,
                          std::uint32_t largest, PictureContent content = PictureContent::All);

    // Records all passes, for a caller who submits them; the last frame's commands must be done.
    // What they need stays from frame to frame, until the size or the number of shapes grows.
    // Throws GpuError like `check_size`, and for meshes like `draw`; where there are more
    // translucent layers than before some may be missing, which the next record makes room for.
    void record(VkCommandBuffer commands, const FrameScene& scene, VkExtent2D size);

    // What the recorded commands draw: an image of `size`, R8G8B8A8_UNORM, its values encoded as
    // sRGB already, times their alpha where `clear_background` is wanted, left in
    // TRANSFER_SRC_OPTIMAL for transfers that come later in the commands. It is another image after
    // a `record` with another size.
    VkImage colour_image() const noexcept { return colour_.handle(); }

    // What is seen at a pixel of the last recorded frame, whose commands are done: a shape's
    // `pick`, or Picture::nothing_seen, also outside of the picture.
    std::uint32_t pick(std::uint32_t x, std::uint32_t y);

private:
    void record_frame(VkCommandBuffer commands, const FrameScene& scene, GpuFrame frame);
    void record_sun(VkCommandBuffer commands, const FrameScene& scene, const glm::mat4& view,
                    const GpuFrame& frame);
    void record_picture(VkCommandBuffer commands, const FrameScene& scene) const;
    void record_nearest_layers(VkCommandBuffer commands) const;
    void create_picture();
    void list_picks(const std::vector<SphereShape>& spheres, const std::vector<ConeShape>& cones);
    Picture draw_frame(const FrameScene& scene, const GpuFrame& frame, PictureContent content);
    bool lacks_layers() const noexcept;  // of the last picture drawn
    std::uint32_t pick_of(std::uint32_t id) const noexcept;

    GpuDevice& device_;
    Pipelines pipelines_;

    // written by every record
    ShapeView view_, sun_view_;
    LayerLists layers_;
    DrawnShapes drawn_;
    Image colour_;
    Framebuffer picture_;
    std::vector<std::uint32_t> picks_;  // of every shape and then every triangle, as numbered
};

// From the world to the camera, and from the camera to the picture's plane, for whoever asks where
// something will be seen: pixel coordinates from the upper left, and the depth in Å.
glm::mat4 view_matrix(const FrameCamera& camera);
glm::vec3 project(const FrameCamera& camera, const glm::vec3& point, std::uint32_t width,
                  std::uint32_t height);

}  // namespace palpa
