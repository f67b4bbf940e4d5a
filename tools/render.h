// palpa render: a picture of a scene, without a window or a display.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

struct RenderOptions {
    std::filesystem::path scene;
    std::vector<std::string> settings;
    std::filesystem::path image;
    std::uint32_t width = 1280, height = 720;
    double time_s = 0;  // simulated, under the emulated hand, before the picture
    std::string representation = "ball-and-stick";
    bool arrow = true;
};

// Throws LoadError or GpuError. Returns the exit code.
int render_command(const RenderOptions& options);

}  // namespace palpa
