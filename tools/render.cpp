#include "tools/render.h"

#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "render/picture.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/components.h"
#include "tools/choice.h"
#include "tools/hands.h"
#include "view/clip.h"
#include "view/first_view.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <system_error>

namespace palpa {
namespace {

// What the options say over the scene's [view].
void apply_options(const RenderOptions& options, Simulation& simulation, ViewDescription& view) {
    if (!options.representation.empty()) {
        view.representation = static_cast<Representation>(
            choice_called("--as", options.representation, representation_names));
    }
    if (!options.colouring.empty()) {
        view.colouring =
            static_cast<Colouring>(choice_called("--colour", options.colouring, colouring_names));
    }
    if (!options.look_at.empty()) {
        std::vector<std::string_view> names;
        simulation.world.each<Molecule>(
            [&](Entity, const Molecule& molecule) { names.emplace_back(molecule.name); });
        view.look_at = names[choice_called("--look-at", options.look_at, names)];
    }
    if (!options.camera.empty()) view.camera = read_camera(options.camera);
    view.clip = options.clips.value_or(view.clip);
}

// Seen by that camera.
void finish_frame(const ViewDescription& view, const Simulation& simulation,
                  const OrbitCamera& camera, FrameScene& frame) {
    const auto grabbed = static_cast<std::uint32_t>(grabbed_points(simulation).positions.size());
    if (view.clip) clip_in_front(grabbed, camera, frame);
    frame.camera = frame_camera(camera, frame);
}

float aspect_of(std::uint32_t width, std::uint32_t height) {
    return static_cast<float>(width) / static_cast<float>(std::max<std::uint32_t>(height, 1));
}

}  // namespace

std::array<double, 3> read_camera(std::string_view text) {
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        numbers.push_back(find_real(text.substr(begin, end - begin)).value_or(NAN));
        begin = end + 1;
    }
    if (numbers.size() == 2) numbers.push_back(1);
    if (numbers.size() != 3 || !std::isfinite(numbers[0]) || !(std::abs(numbers[1]) <= 90) ||
        !(numbers[2] >= 0.01 && numbers[2] <= 100)) {
        throw LoadError({fmt::format("--camera {}", text)},
                        "expected AZIMUTH,ELEVATION[,ZOOM]: degrees, the second from -90 to 90, "
                        "and a factor from 0.01 to 100");
    }
    return {numbers[0], numbers[1], numbers[2]};
}

int render_command(const RenderOptions& options) {
    SceneDescription scene = read_scene(options.scene, options.settings);
    const Existing existing = check_output(options.image, picture_mark, options.overwrites);
    const std::int64_t pixels = std::int64_t{options.width} * options.height * options.samples;
    if (pixels > most_pixels) {
        throw LoadError({"--samples"},
                        fmt::format("{} pixels in all; expected {} at most", pixels, most_pixels));
    }
    if (!options.camera.empty()) (void)read_camera(options.camera);  // before anything is loaded
    Simulation simulation = load_simulation(scene);
    apply_options(options, simulation, scene.view);
    ViewSettings view = first_settings(scene.view, simulation);
    view.force_arrow = options.arrow;
    if (options.time_s > 0) {
        scene.seconds = options.time_s;
        EmulatedOmni device(build_emulated_omni(scene, simulation));
        run_headless(scene, simulation, device, {}, nullptr, {});
    }
    FrameScene frame = build_frame(simulation, view);
    const float aspect = aspect_of(options.width, options.height);
    const OrbitCamera camera =
        first_camera(scene.view, frame, framed_atoms(scene.view, simulation), aspect);
    finish_frame(scene.view, simulation, camera, frame);

    GpuDevice gpu{GpuOptions{}};
    Renderer renderer(gpu);
    const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(options.samples)));
    frame.outline = static_cast<int>(side);
    const Picture drawn =
        renderer.draw(frame, side * options.width, side * options.height, PictureContent::Colours);
    const Picture picture = side == 1 ? drawn : average_down(drawn, side);
    write_png(options.image, picture, existing);
    fmt::print("{}: {}x{} on {}\n", options.image.string(), picture.width, picture.height,
               gpu.name());
    return 0;
}

FrameWriter::FrameWriter(const std::filesystem::path& folder, std::uint32_t width,
                         std::uint32_t height, const ViewDescription& view)
    : folder_(folder),
      width_(width),
      height_(height),
      view_(view),
      gpu_(GpuOptions{}),
      renderer_(gpu_) {
    renderer_.check_size({width, height});
}

void FrameWriter::write(Simulation& simulation) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw LoadError({folder_.string()}, "cannot be made: " + error.message());
    FrameScene frame = build_frame(simulation, first_settings(view_, simulation));
    if (written_ == 0) {
        camera_ =
            first_camera(view_, frame, framed_atoms(view_, simulation), aspect_of(width_, height_));
    }
    finish_frame(view_, simulation, camera_, frame);
    write_png(folder_ / fmt::format("{:04}.png", written_++),
              renderer_.draw(frame, width_, height_, PictureContent::Colours));
}

}  // namespace palpa
