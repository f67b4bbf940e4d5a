#include "tools/render.h"

#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "gpu/device.h"
#include "render/picture.h"
#include "render/renderer.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/simulation.h"
#include "tools/run.h"
#include "view/build_frame.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {
namespace {

Representation representation_called(const std::string& name) {
    const auto found = std::find(representation_names.begin(), representation_names.end(), name);
    if (found == representation_names.end()) {
        throw LoadError({"--as " + name},
                        fmt::format("expected one of {}{}", fmt::join(representation_names, ", "),
                                    near_name_hint(name, representation_names)));
    }
    return static_cast<Representation>(found - representation_names.begin());
}

}  // namespace

int render_command(const RenderOptions& options) {
    SceneDescription scene = read_scene(options.scene, options.settings);
    const ViewSettings view{representation_called(options.representation), options.arrow};
    Simulation simulation = load_simulation(scene);
    if (options.time_s > 0) {
        scene.seconds = options.time_s;
        EmulatedOmni device(build_emulated_omni(scene, simulation));
        run_headless(scene, simulation, device, {}, nullptr, {});
    }
    GpuDevice gpu{GpuOptions{}};
    Renderer renderer(gpu);
    const float aspect = static_cast<float>(options.width) /
                         static_cast<float>(std::max<std::uint32_t>(options.height, 1));
    const Picture picture = renderer.draw(build_frame(simulation, view, aspect), options.width,
                                          options.height, PictureContent::Colours);
    write_png(options.image, picture);
    fmt::print("{}: {}x{} on {}\n", options.image.string(), picture.width, picture.height,
               gpu.name());
    return 0;
}

}  // namespace palpa
