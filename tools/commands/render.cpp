#include "tools/commands/render.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "formats/crd.h"
#include "loading/load.h"
#include "molecule/select.h"
#include "render/film.h"
#include "render/picture.h"
#include "scene/read_scene.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/select_in_world.h"
#include "tools/commands/choice.h"
#include "tools/commands/command.h"
#include "tools/commands/film.h"
#include "tools/commands/print_run.h"
#include "tools/commands/progress.h"
#include "view/clip.h"
#include "view/first_view.h"
#include "view/hydrogen_bonds.h"
#include "view/saved_views.h"
#include "view/selected_atoms.h"
#include "view/worded_picture.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

// A --representation is of everything, or of what the --of behind it selects, and is a layer then;
// --colour and --opacity are of the layer before them, or of everything.
void apply_looks(const std::vector<RenderOptions::Said>& said, ViewDescription& view) {
    std::optional<ViewLayer> layer;  // begun; one without `of` is everything
    const auto finish = [&] {
        if (!layer) return;
        // What shines through is a layer of everything, and nothing else is drawn of it.
        if (layer->of.empty() && layer->opacity < 1) view.hidden.emplace_back("all");
        if (layer->of.empty() && !(layer->opacity < 1)) {
            view.representation = layer->representation;
            view.colouring = layer->colouring.value_or(view.colouring);
        } else {
            view.layers.push_back(*layer);
        }
        layer.reset();
    };
    for (const auto& [option, value] : said) {
        if (option == "--representation") {
            finish();
            layer.emplace().representation =
                static_cast<Representation>(choice_called(option, value, representation_names));
        } else if (option == "--of") {
            if (!layer)
                throw LoadError({"--of " + value}, "expected --representation NAME before it");
            if (!layer->of.empty())
                throw LoadError({"--of " + value},
                                "is a second selection for one representation; expected another "
                                "--representation before it, or 'or' between the two");
            (void)parse_selection(value, "--of");
            layer->of = value;
        } else if (option == "--colour") {
            const auto colouring =
                static_cast<Colouring>(choice_called(option, value, colouring_names));
            (layer ? layer->colouring.emplace() : view.colouring) = colouring;
        } else {
            const std::optional<double> opacity = find_real(value);
            if (!layer || layer->representation != Representation::Surface || !opacity ||
                !(*opacity >= 0.05 && *opacity <= 1))
                throw LoadError({"--opacity " + value},
                                "expected 0.05 to 1, after --representation surface");
            layer->opacity = *opacity;
        }
    }
    finish();
}

// Null where none is asked for.
const SavedView* find_asked_view(const RenderOptions& options, const ViewDescription& view) {
    if (options.saved_view.empty()) return nullptr;
    std::vector<std::string_view> names;
    for (const SavedView& saved : view.saved) names.emplace_back(saved.name);
    if (names.empty())
        throw LoadError({"--view " + options.saved_view},
                        "the scene has no saved views; expected [[view.saved]] in its file");
    return &view.saved[choice_called("--view", options.saved_view, names)];
}

template <class Enum, std::size_t Count>
void choose_if_given(const char* option, const std::string& value,
                     const std::array<std::string_view, Count>& names, Enum& chosen) {
    if (!value.empty()) chosen = static_cast<Enum>(choice_called(option, value, names));
}

void apply_marks(const MarkOptions& options, ViewMarks& marks) {
    for (const std::string& measure : options.measures) {
        (void)parse_measure(measure, "--measure");
        marks.measures.push_back(measure);
    }
    choose_if_given("--contacts", options.contacts, shown_bond_names, marks.contacts);
    choose_if_given("--forces", options.forces, shown_force_names, marks.forces);
    marks.ghost = marks.ghost || options.ghost;
    marks.trail_s = options.trail_s.value_or(marks.trail_s);
}

// What the options say over the scene's [view].
void apply_options(const RenderOptions& options, World& world, ViewDescription& view) {
    if (const SavedView* const saved = find_asked_view(options, view)) {
        if (saved->representation) view.representation = saved->representation;
        view.layers.insert(view.layers.end(), saved->layers.begin(), saved->layers.end());
        view.clip = false;  // as in a window
    }
    apply_looks(options.said, view);
    for (const std::string& label : options.labels) {
        (void)parse_selection(label, "--label");
        view.labels.push_back(label);
    }
    choose_if_given("--hydrogen-bonds", options.hydrogen_bonds, shown_bond_names,
                    view.hydrogen_bonds);
    choose_if_given("--hydrogens", options.hydrogens, shown_hydrogen_names, view.hydrogens);
    choose_if_given("--shadows", options.shadows, shadow_names, view.shadows);
    view.occlusion = options.has_occlusion.value_or(view.occlusion);
    view.outline = options.outline.value_or(static_cast<int>(view.outline));
    apply_marks(options.marks, view.marks);
    if (!options.look_at.empty()) {
        std::vector<std::string_view> names;
        world.each<Molecule>(
            [&](Entity, const Molecule& molecule) { names.emplace_back(molecule.name); });
        view.look_at = names[choice_called("--look-at", options.look_at, names)];
    }
    if (!options.camera.empty()) view.camera = read_camera(options.camera);
    view.clip = options.clips.value_or(view.clip);
}

// Stands first in what is written, by which it is known again.
constexpr std::string_view coordinates_title = "Written by palpa render.\n";

}  // namespace

OrbitCamera render_camera(const SceneDescription& scene, const RenderOptions& options,
                          const World& world, const FrameScene& frame) {
    const float aspect = aspect_of(options.width, options.height);
    const SavedView* const saved = find_asked_view(options, scene.view);
    if (!saved) return first_camera(scene.view, frame, framed_atoms(scene.view, world), aspect);
    std::vector<glm::vec3> places;
    for (const Vec3& place : world.resource<AtomTable>().positions)
        places.push_back(as_float(place));
    const std::vector<bool> framed =
        saved->look_at.empty() ? std::vector<bool>() : select_as_seen(world, saved->look_at);
    return saved_camera(*saved, places, framed, aspect);
}

void finish_frame(const ViewDescription& view, const World& world, const OrbitCamera& camera,
                  FrameScene& frame) {
    if (view.clip) clip_in_front(held_range(world, hand_at(world, 0)), camera, frame);
    frame.camera = frame_camera(camera, frame);
}

float aspect_of(std::uint32_t width, std::uint32_t height) {
    return static_cast<float>(width) / static_cast<float>(std::max<std::uint32_t>(height, 1));
}

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

namespace {

// What can be said of the options before anything is loaded.
void check_render_options(const RenderOptions& options) {
    if (options.image.empty() == !options.film)
        throw LoadError({"palpa render"},
                        "needs one output; expected -o FILE.png or --film FILE.mp4");
    if (!options.film && upper_case(options.image.extension().string()) != ".PNG")
        throw LoadError({"-o " + options.image.string()},
                        "pictures are PNG files; expected a name that ends in .png");
    if (options.film && options.coordinates)
        throw LoadError({"--coordinates"},
                        "belongs to a picture; expected -o in place of --film, or palpa export");
    if (options.film) check_film({*options.film, options.film_fps, options.overwrites});
}

// A note on standard error where there are such.
void print_left_out(const LeftOutWords& left_out, const PictureWords& words) {
    if (left_out.labels > 0) {
        fmt::print(stderr, "note: {} of {} labels found no room in the picture\n", left_out.labels,
                   words.labels.size());
    }
    if (left_out.has_legend)
        fmt::print(stderr, "note: the legend of colours found no room in the picture\n");
}

}  // namespace

int render_command(const RenderOptions& options) {
    SceneDescription scene = read_scene(options.scene, options.settings);
    print_notes(scene.notes);
    refuse_remote_engine(scene);
    check_render_options(options);
    const Existing existing = options.film
                                  ? Existing::Refuse
                                  : check_output(options.image, picture_mark, options.overwrites);
    const Existing existing_coordinates =
        options.coordinates
            ? check_output(*options.coordinates, fmt::format("* {}", coordinates_title),
                           options.overwrites)
            : Existing::Refuse;
    const std::int64_t pixels = std::int64_t{options.width} * options.height * options.samples;
    if (pixels > most_pixels) {
        throw LoadError({options.samples > 1 ? "--samples" : "--size"},
                        fmt::format("{} pixels in all; expected {} at most", pixels, most_pixels));
    }
    if (!options.camera.empty()) (void)read_camera(options.camera);  // before anything is loaded
    ProgressLine progress;
    const StageFunction on_stage = progress.stages();
    World world = load_world(scene, on_stage);
    apply_options(options, world, scene.view);
    for (const std::string& empty : find_empty_selections(scene.view, world))
        fmt::print(stderr, "palpa render: no atom matches {}\n", empty);
    ViewSettings view = first_settings(scene.view, world);
    view.force_arrow = options.arrow;
    if (options.film) return make_film(scene, world, view, options, progress);
    FrameBuilder builder;
    builder.follow(world, view.marks);
    if (options.time_s > 0) {
        constexpr double looks_per_s = 100;  // for what was before
        const auto look = [&] { builder.follow(world, view.marks); };
        scene.seconds = options.time_s;
        EmulatedOmni device(build_emulated_omni(scene, world));
        run_headless(scene, world, device, {}, nullptr, progress.shares("playing"),
                     {looks_per_s, look});
    }
    tell(on_stage, "drawing");
    WordedFrame frame = build_worded_frame(builder, world, view);
    const OrbitCamera camera = render_camera(scene, options, world, frame.scene);
    finish_frame(scene.view, world, camera, frame.scene);

    GpuDevice gpu{GpuOptions{}};
    Renderer renderer(gpu);
    std::vector<std::string> warnings;
    std::optional<TextPainter> painter;
    if (options.words) painter = open_words(warnings);
    frame.scene.clear_background = options.transparent;
    frame.scene.is_fine = true;
    LeftOutWords left_out;
    const Picture picture = draw_worded(renderer, {options.width, options.height, options.samples},
                                        frame, painter, &left_out);
    write_png(options.image, picture, existing);
    progress.wipe();
    print_warnings(warnings);
    print_left_out(left_out, frame.words);
    fmt::print("{}: {}x{} on {}\n", options.image.string(), picture.width, picture.height,
               gpu.name());
    if (options.coordinates) {
        Structure structure;
        structure.names = world.resource<AtomTable>().names;
        structure.weights = world.resource<AtomTable>().b_factor;
        structure.positions = world.resource<AtomTable>().positions;
        write_text_file(*options.coordinates,
                        format_crd(structure, fmt::format("{}{}\n{} s simulated", coordinates_title,
                                                          scene.title, options.time_s)),
                        existing_coordinates);
        fmt::print("{}: {} atoms, hydrogen bonds in all: {}\n", options.coordinates->string(),
                   structure.names.size(), find_hydrogen_bonds(world, ShownBonds::All).size());
    }
    return 0;
}

FrameWriter::FrameWriter(const std::filesystem::path& folder, std::uint32_t width,
                         std::uint32_t height, const ViewDescription& view,
                         std::optional<TextPainter> painter)
    : folder_(folder),
      width_(width),
      height_(height),
      view_(view),
      gpu_(GpuOptions{}),
      renderer_(gpu_),
      painter_(std::move(painter)) {
    renderer_.check_size({width, height});
}

void FrameWriter::write(World& world) {
    make_folder(folder_);
    WordedFrame frame = build_worded_frame(builder_, world, first_settings(view_, world));
    if (written_ == 0) {
        camera_ = first_camera(view_, frame.scene, framed_atoms(view_, world),
                               aspect_of(width_, height_));
    }
    finish_frame(view_, world, camera_, frame.scene);
    write_png(folder_ / fmt::format("{:04}.png", written_++),
              draw_worded(renderer_, {width_, height_}, frame, painter_));
}

namespace {

// Options whose order counts.
void add_look_options(CLI::App& render, RenderOptions& options) {
    const auto add = [&](const char* names, const char* type, const std::string& meaning) {
        return render.add_option(names, meaning)
            ->type_name(type)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    };
    const std::array looks{
        add("--representation,--as", "NAME",
            fmt::format("{}; for everything, or for the selection of a following --of, drawn in "
                        "addition; can be repeated",
                        fmt::join(representation_names, ", "))),
        add("--of", "SELECTION",
            "selection for the representation before it: \"within 5 of ligand\""),
        add("--colour", "NAME",
            fmt::format("{}; for the --representation before it, or for everything",
                        fmt::join(colouring_names, ", "))),
        add("--opacity", "SHARE", "opacity of a surface, 0.05 to 1")};
    render.parse_complete_callback([&render, &options, looks] {
        std::array<std::size_t, looks.size()> next{};
        for (const CLI::Option* const option : render.parse_order()) {
            const auto found = std::ranges::find(looks, option);
            if (found == looks.end()) continue;
            std::size_t& index = next[static_cast<std::size_t>(found - looks.begin())];
            constexpr std::array<std::string_view, 4> names{"--representation", "--of", "--colour",
                                                            "--opacity"};
            options.said.push_back(
                {std::string(names[static_cast<std::size_t>(found - looks.begin())]),
                 option->results().at(index++)});
        }
    });
    add("--label", "SELECTION", "label the residues of this selection, or a single atom");
    render.get_option("--label")->each(
        [&](const std::string& value) { options.labels.push_back(value); });
    render
        .add_option("--hydrogen-bonds", options.hydrogen_bonds,
                    "draw hydrogen bonds: none, in-hand (of the molecule in hand) or all (without "
                    "a value: all)")
        ->expected(0, 1)
        ->default_str("all");
    render.add_option(
        "--hydrogens", options.hydrogens,
        fmt::format("{}; polar: bonded to N, O or S", fmt::join(shown_hydrogen_names, ", ")));
    render.add_option(
        "--shadows", options.shadows,
        fmt::format("{}; shadows of objects on each other", fmt::join(shadow_names, ", ")));
    render.add_flag_callback(
        "--no-occlusion", [&options] { options.has_occlusion = false; }, "do not darken crevices");
    render.add_option("--outline", options.outline, "width of the outline in pixels (default 1)")
        ->check(in_range(0, 8));
    render.add_flag("--transparent", options.transparent, "the background");
}

void add_mark_options(CLI::App& render, MarkOptions& marks) {
    render
        .add_option("--measure",
                    "\"SELECTION; SELECTION[; SELECTION[; SELECTION]]\": distance, angle or "
                    "dihedral of their atoms or centres; can be repeated")
        ->type_name("SELECTIONS")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->each([&](const std::string& value) { marks.measures.push_back(value); });
    render
        .add_option("--contacts", marks.contacts,
                    "draw contacts, clashes and salt bridges: none, in-hand or all (without a "
                    "value: in-hand)")
        ->expected(0, 1)
        ->default_str("in-hand");
    render
        .add_option("--forces", marks.forces,
                    fmt::format("{}: their forces on the molecule in hand, as arrows",
                                fmt::join(shown_force_names, ", ")))
        ->type_name("NAME");
    render.add_flag("--ghost", marks.ghost, "draw the molecule in hand also at its start, pale");
    render.add_option("--trail", marks.trail_s, "draw its path over this many seconds before")
        ->check(in_range(0.0, 1e4))
        ->type_name("SECONDS");
}

}  // namespace

void add_render(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& render =
        *program.add_subcommand("render", "Draw a picture or a film of a scene, without a display");
    RenderOptions& options = own_options<RenderOptions>(render, chosen, render_command);
    describe(render, {"palpa render scenes/hiv -o tunnel.png",
                      "palpa render scenes/hiv -o pocket.png --representation surface --of protein "
                      "--opacity 0.5",
                      "palpa render scenes/water --film water.mp4 --seconds 4",
                      "palpa render scenes/water --film water-frames --seconds 4"});
    render.add_option("scene", options.scene, "scene folder or file")->required();
    render.add_option("-o,--output", options.image, "PNG file to write")->type_name("FILE.png");
    CLI::Option* const film =
        render
            .add_option("--film", options.film,
                        "make a film by ffmpeg; if ffmpeg fails, its pictures stay in the folder "
                        "FILE-frames and the exit code is 1; a name without an ending is a folder "
                        "for numbered pictures")
            ->type_name("FILE.mp4");
    render
        .add_option("--seconds", options.film_seconds,
                    "length of the film in simulated seconds (default 10)")
        ->check(in_range(0.001, 1e5))
        ->needs(film);
    render.add_option("--fps", options.film_fps, "pictures per simulated second (default 25)")
        ->check(in_range(0.01, 1000.0))
        ->needs(film);
    render.add_option("--coordinates", options.coordinates,
                      "also write the coordinates of the picture to this CHARMM file (.crd)");
    add_overwrite_flag(render, options.overwrites);
    add_size_option(render, "--size", options.width, options.height);
    render.add_option("--time", options.time_s, "simulated seconds to play before, s")
        ->check(in_range(0.0, 1e5));
    add_look_options(render, options);
    add_mark_options(render, options.marks);
    render
        .add_option("--camera", options.camera,
                    "view direction: degrees around the centre and above it; zoom factor")
        ->type_name("AZIMUTH,ELEVATION[,ZOOM]");
    render.add_option("--look-at", options.look_at,
                      "frame this molecule of the scene (default: all)");
    render.add_option("--view", options.saved_view, "a saved view of the scene, by its name")
        ->type_name("NAME")
        ->excludes("--camera", "--look-at");
    render.add_flag_callback(
        "--clip", [&options] { options.clips = true; },
        "hide atoms in front of the molecule in hand");
    render.add_flag_callback(
        "--no-clip", [&options] { options.clips = false; },
        "show atoms in front, whatever the scene says");
    render.add_option("--samples", options.samples, "samples per pixel: 1, 4, 9 or 16")
        ->check(CLI::IsMember({1, 4, 9, 16}));
    add_negation(render, "--no-arrow", options.arrow, "do not draw the force on the molecule");
    add_negation(render, "--no-words", options.words,
                 "do not draw labels, lengths, forces and the colour legend");
    add_set_option(render, options.settings);
}

}  // namespace palpa
