// palpa render: a picture of a scene, without a window or a display. And pictures of a run.
#pragma once
#include "ecs/world.h"
#include "gpu/device.h"
#include "render/renderer.h"
#include "render/text.h"
#include "view/build_frame.h"
#include "view/orbit_camera.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Of a picture with all its samples: it takes some 2 GiB until it is written.
inline constexpr std::int64_t most_pixels = std::int64_t{1} << 26;

// Over the scene's [view], where they are given.
struct MarkOptions {
    std::vector<std::string> measures;  // besides those of the scene
    std::string contacts, forces;       // names of choices
    bool ghost = false;
    std::optional<double> trail_s;
};

struct RenderOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;
    std::filesystem::path image;
    std::optional<std::filesystem::path> coordinates;  // to write too
    std::uint32_t width = 1280, height = 720;
    double time_s = 0;  // simulated, under the emulated hand, before the picture
    std::optional<std::filesystem::path> film;  // instead of the picture
    double film_seconds = 10, film_fps = 25;    // simulated; pictures in each of them
    // As the scene's [view] says, but for these, in the order of the command line.
    struct Said {
        std::string option;  // "--representation", "--of", "--colour" or "--opacity"
        std::string value;
    };
    std::vector<Said> said;
    std::vector<std::string> labels;
    std::string hydrogen_bonds, hydrogens, shadows;
    std::optional<bool> has_occlusion;
    std::optional<int> outline;
    MarkOptions marks;
    bool transparent = false;  // the background
    std::string camera;        // azimuth, elevation in degrees, zoom
    std::string look_at;       // a molecule's name
    std::string saved_view;    // of the scene's, by name
    std::optional<bool> clips;
    std::uint32_t samples = 1;  // a pixel: 1, 4, 9 or 16
    bool overwrites = false;    // earlier files of this command
    bool arrow = true;
    bool words = true;
};

// Throws LoadError or GpuError. Returns the exit code.
int render_command(const RenderOptions& options);

// "AZIMUTH,ELEVATION" or "AZIMUTH,ELEVATION,ZOOM": degrees, and a factor above 0 by which the
// camera comes nearer than where it sees everything; as [view] has them. Throws LoadError that
// names the option.
std::array<double, 3> read_camera(std::string_view text);

// The camera of the saved view that the options name, or the scene's first one. Throws LoadError.
OrbitCamera render_camera(const SceneDescription& scene, const RenderOptions& options,
                          const World& world, const FrameScene& frame);

// Seen by that camera.
void finish_frame(const ViewDescription& view, const World& world, const OrbitCamera& camera,
                  FrameScene& frame);

// Of a picture of this size.
float aspect_of(std::uint32_t width, std::uint32_t height);

// frames/0000.png and on in a recording, all from where the scene is seen at first; with words
// where there is a painter.
class FrameWriter {
public:
    // Throws GpuError where nothing can draw, or nothing of that size.
    FrameWriter(const std::filesystem::path& folder, std::uint32_t width, std::uint32_t height,
                const ViewDescription& view, std::optional<TextPainter> painter);

    // Throws GpuError, or LoadError where it cannot be written.
    void write(World& world);

private:
    std::filesystem::path folder_;
    std::uint32_t width_, height_, written_ = 0;
    ViewDescription view_;
    GpuDevice gpu_;
    Renderer renderer_;
    FrameBuilder builder_;
    OrbitCamera camera_;
    std::optional<TextPainter> painter_;
};

}  // namespace palpa
