// palpa render: a picture of a scene, without a window or a display. And pictures of a run.
#pragma once
#include "gpu/device.h"
#include "render/renderer.h"
#include "simulation/simulation.h"
#include "view/build_frame.h"
#include "view/orbit_camera.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Of a picture with all its samples: it takes some 2 GiB until it is written.
inline constexpr std::int64_t most_pixels = std::int64_t{1} << 26;

struct RenderOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;
    std::filesystem::path image;
    std::uint32_t width = 1280, height = 720;
    double time_s = 0;           // simulated, under the emulated hand, before the picture
    std::string representation;  // empty: what shows the scene best
    std::string colouring = "chain";
    std::string camera = "0,0";  // azimuth, elevation in degrees, zoom
    std::string look_at;         // a molecule's name; all of them if empty
    std::uint32_t samples = 1;   // a pixel: 1, 4, 9 or 16
    bool overwrites = false;     // an earlier file of this command
    bool arrow = true;
};

// Throws LoadError or GpuError. Returns the exit code.
int render_command(const RenderOptions& options);

// "AZIMUTH,ELEVATION" or "AZIMUTH,ELEVATION,ZOOM": degrees, and a factor above 0 by which the
// camera comes nearer than where it sees everything. Throws LoadError that names the option.
struct CameraChoice {
    float azimuth = 0, elevation = 0;  // rad
    float zoom = 1;
};
CameraChoice read_camera(std::string_view text);

// frames/0000.png and on in a recording, seen by a camera that frames everything at first and then
// stands still.
class FrameWriter {
public:
    // Throws GpuError where nothing can draw, or nothing of that size.
    FrameWriter(const std::filesystem::path& folder, std::uint32_t width, std::uint32_t height);

    // Throws GpuError, or LoadError where it cannot be written.
    void write(const Simulation& simulation);

private:
    std::filesystem::path folder_;
    std::uint32_t width_, height_, written_ = 0;
    GpuDevice gpu_;
    Renderer renderer_;
    OrbitCamera camera_;
};

}  // namespace palpa
