// Selects the visible shapes of a large scene.
#pragma once
#include "render/frame_scene.h"
#include "render/gpu_frame.h"

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

namespace palpa {

// Omits invisible shapes. Reuse one instance for many frames to keep its memory.
class DrawnShapes {
public:
    // Of the scene's spheres and cones, in their order, those that may be seen. Omitted are
    // shapes outside of the view or wholly hidden by nearer spheres: the picture is the same to the
    // bit.
    //
    // Only where `scene.is_coarse`, and more than 100,000 shapes are smaller than a pixel in
    // radius (cones: than half of one), is it another one: of those whose middles are in the same 2
    // x 2 pixels only the nearest sphere and the nearest cone are drawn, as large as that.
    void choose(const FrameScene& scene, const glm::mat4& view, const GpuFrame& frame);

    const std::vector<SphereShape>& spheres() const noexcept { return spheres_; }
    const std::vector<ConeShape>& cones() const noexcept { return cones_; }

private:
    // The bounding ball of a shape in camera space.
    struct Bound {
        float x, y;       // centre in the picture, pixels from the upper left
        float distance;   // distance of its centre in front of the camera, Å
        float radius;     // Å
        float reach;      // largest extent to either side of its centre, pixels
        float thickness;  // Å: the shape's own radius
        bool is_drawn;    // visible and not thinned out
        bool is_free;     // may be left out: not on top
    };
    Bound bound_of(const glm::vec3& centre, float radius, float thickness) const;
    void find_bounds(const FrameScene& scene, const glm::mat4& view);
    void cover(const Bound& sphere);
    bool is_covered(const Bound& bound) const;
    bool is_small(const Bound& bound, float pixels) const;
    std::size_t count_small(const std::vector<Bound>& bounds, float pixels) const;
    void thin_out(std::vector<Bound>& bounds, float pixels);

    GpuFrame frame_{};
    std::int32_t width_ = 0, height_ = 0;
    std::vector<float> covered_;          // for each pixel: distance that is covered, Å
    std::vector<std::uint32_t> nearest_;  // nearest shape of each 2 x 2 pixels, from 1
    std::vector<Bound> sphere_bounds_, cone_bounds_;
    std::vector<SphereShape> spheres_;
    std::vector<ConeShape> cones_;
};

}  // namespace palpa
