#include "tools/commands/film.h"

#include "core/interrupt.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "gpu/device.h"
#include "render/film.h"
#include "render/renderer.h"
#include "session/run_headless.h"
#include "tools/commands/print_run.h"
#include "view/worded_picture.h"

#include <fmt/format.h>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace palpa {

int make_film(SceneDescription scene, World& world, const ViewSettings& view,
              const RenderOptions& options, ProgressLine& progress) {
    GpuDevice gpu{GpuOptions{}};
    Renderer renderer(gpu);
    const PictureSize size{options.width, options.height, options.samples};
    std::vector<std::string> warnings;
    std::optional<TextPainter> painter;
    if (options.words) painter = open_words(warnings);
    progress.wipe();
    print_warnings(warnings);
    renderer.check_size(size.drawn());
    Film film({*options.film, options.film_fps, options.overwrites});

    const auto most =
        static_cast<std::size_t>(std::ceil(options.film_seconds * options.film_fps - 1e-9));
    std::optional<OrbitCamera> camera;
    FrameBuilder builder;
    std::size_t due = 0;
    const auto draw = [&] {
        builder.follow(world, view.marks);
        const double now_s = static_cast<double>(due++) / options.film_fps;
        if (now_s < options.time_s - 1e-9 || film.frame_count() >= most) return;
        WordedFrame frame = build_worded_frame(builder, world, view);
        if (!camera) {
            camera = render_camera(scene, options, world, frame.scene);
        }
        finish_frame(scene.view, world, *camera, frame.scene);
        film.add(draw_worded(renderer, size, frame, painter));
    };
    scene.seconds = options.time_s + options.film_seconds;
    EmulatedOmni device(build_emulated_omni(scene, world));
    note_interrupts();  // a film that is begun is ended in order
    run_headless(scene, world, device, {}, nullptr, progress.shares("filming"),
                 {options.film_fps, draw}, {}, [] { return noted_interrupt() != 0; });
    progress.wipe();
    tell(progress.stages(), "making the film");
    const FilmEnd end = film.finish();
    progress.wipe();
    if (end.is_film) {
        fmt::print("{}: {} pictures of {}x{}, {} a second, on {}\n", options.film->string(),
                   film.frame_count(), options.width, options.height, options.film_fps, gpu.name());
    } else {
        fmt::print("{}: {} pictures of {}x{}{}{}\n", end.folder.string(), film.frame_count(),
                   options.width, options.height, end.is_done ? "" : "; ", end.why);
    }
    return exit_code_after(end.is_done ? 0 : 1);
}

}  // namespace palpa
