#include "app/recorder.h"

#include "app/editing.h"
#include "app/notices.h"
#include "app/screenshots.h"
#include "app/window_world.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "render/picture.h"
#include "session/coordinates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// A name for coordinates; a PSF comes with a CRD.
fs::path name_coordinates(const World& app, const std::string& ending) {
    const fs::path& folder = options_of(app).files_folder;
    return ending == ".psf" ? find_free_name(folder, "palpa", {".psf", ".crd"})
                            : find_free_name(folder, "palpa", {ending});
}

// Runs what may fail for want of room or rights, and tells the person why.
template <class Task>
void try_to(World& app, const Task& task) {
    try {
        task();
    } catch (const LoadError& error) {
        tell(app, error.what(), long_notice_s);
    }
}

// The last seconds of the hand, and the labels of the present picture.
void export_readings(World& app) {
    std::string text = "x_angstrom,y_angstrom,z_angstrom,label\n";
    for (const ViewLabel& label : frame_of(app).labels) {
        std::string quoted;
        for (const char letter : label.text)
            quoted += letter == '"' ? "\"\"" : std::string(1, letter);
        text +=
            fmt::format("{},{},{},\"{}\"\n", label.place.x, label.place.y, label.place.z, quoted);
    }
    try_to(app, [&] {
        const fs::path file = name_coordinates(app, ".csv");
        fs::path marks = file;
        marks.replace_filename(file.stem().string() + "-marks.csv");
        const std::string readings = format_readings(app.resource<Readings>().history.samples());
        const std::array files{TextFile{file, readings}, TextFile{marks, text}};
        write_text_files(files);
        tell(app, fmt::format("saved {} (the last {:.0f} s) and {} (the present marks)",
                              file.string(), History::seconds, marks.string()));
    });
}

void export_coordinates(World& app, const std::string& ending,
                        const std::vector<std::string>& molecules) {
    try_to(app, [&] {
        const World world = session_of(app).copy_world();
        const fs::path file = name_coordinates(app, ending);
        const std::vector<std::uint32_t> atoms = select_atoms(world, molecules);
        write_text_files(format_coordinates(world, atoms, file, scene_of(app).title));
        tell(app, format_translated("saved {}: {} atoms", file.string(), atoms.size()));
    });
}

void ask_what_to_export(World& app, const std::string& ending) {
    const std::string in_hand = molecule_in_hand(app);
    if (in_hand.empty()) return export_coordinates(app, ending, {});
    app.write<Dialogs>().question = {
        translated("Save coordinates of"),
        {{Key::A, translated("all that is shown (A)"),
          [&app, ending] { export_coordinates(app, ending, {}); }},
         {Key::H, format_translated("{} in hand (H)", in_hand),
          [&app, ending, in_hand] { export_coordinates(app, ending, {in_hand}); }},
         {Key::Escape, translated("Not (Esc)")}}};
}

// Prints them on standard error too, where they stay.
void tell_recording_notes(World& app) {
    for (const std::string& note : session_of(app).take_recording_notes()) {
        fmt::print(stderr, "note: {}\n", note);
        tell(app, note, long_notice_s);
    }
}

// Once a recording.
void tell_of_disk(World& app) {
    constexpr double least_s = 600;
    const std::optional<RecordingState> state = session_of(app).recording();
    const std::optional<double> left_s = state ? seconds_left(*state) : std::nullopt;
    if (!left_s || *left_s > least_s || app.resource<Recorder>().warned_of_disk) return;
    app.write<Recorder>().warned_of_disk = true;
    tell(app,
         format_translated("the disk has room for {:.0f} minutes of this recording: {} are left",
                           std::floor(*left_s / 60), describe_bytes(*state->free_bytes)),
         long_notice_s);
}

void tell_of_compression(World& app) {
    for (const EndedRecording& ended : session_of(app).take_ended()) {
        const std::string folder = ended.folder.string();
        tell(app,
             ended.problem.empty()
                 ? format_translated("recorded into {0}, {1}; to play it: Ctrl+O, O, its "
                                     "journal.txt.gz",
                                     folder, describe_bytes(ended.bytes))
                 : format_translated("recorded into {0}, {1}, but it could not be compressed: {2}",
                                     folder, describe_bytes(ended.bytes), ended.problem),
             long_notice_s);
    }
}

void tell_of_film(World& app) {
    Recorder& recorder = app.write<Recorder>();
    if (!recorder.film) return;
    constexpr double while_it_lasts_s = 1;
    const FilmRecorder& film = *recorder.film;
    if (const std::optional<std::string> outcome = film.outcome()) {
        recorder.film.reset();
        tell(app, *outcome, long_notice_s);
    } else if (film.is_ended()) {
        tell(app,
             format_translated("writing {}: {} pictures left", recorder.filmed_in.string(),
                               film.waiting()),
             while_it_lasts_s);
    } else {
        tell(app,
             format_translated("filming {}: {:.0f} s; press M to end", recorder.filmed_in.string(),
                               film.filmed_s()),
             while_it_lasts_s);
    }
}

}  // namespace

void take_screenshot(World& app) { app.write<Recorder>().wants_shot = true; }

bool wants_shot(const World& app) {
    const Recorder& recorder = app.resource<Recorder>();
    return recorder.wants_shot || (recorder.film && recorder.film->is_due());
}

void save_shot(World& app, const WindowShot& shot) {
    Recorder& recorder = app.write<Recorder>();
    if (recorder.film && recorder.film->is_due())
        recorder.film->add({shot.width, shot.height, shot.rgba, {}, {}});
    if (!std::exchange(recorder.wants_shot, false)) return;
    const WindowOptions& options = options_of(app);
    FrameLoop& loop = app.write<FrameLoop>();
    if (loop.takes_last_shot && options.last_shot) {  // an error if it fails
        write_png(*options.last_shot, {shot.width, shot.height, shot.rgba, {}, {}},
                  options.last_shot_existing);
        loop.is_quitting = true;
        return;
    }
    try_to(app, [&] {
        tell(app,
             format_translated("saved {}", save_screenshot(options.files_folder, shot).string()));
    });
}

void film_or_end(World& app) {
    Recorder& recorder = app.write<Recorder>();
    if (recorder.film) return recorder.film->end();
    try_to(app, [&] {
        recorder.filmed_in =
            find_free_name(options_of(app).files_folder, "palpa", {".mp4", ".mp4-frames"});
        recorder.film = std::make_shared<FilmRecorder>(FilmSettings{.file = recorder.filmed_in});
    });
}

void record_or_end(World& app) {
    Recorder& recorder = app.write<Recorder>();
    WindowSession& session = session_of(app);
    try_to(app, [&] {
        if (session.recording()) {
            session.end_recording();
            tell_recording_notes(app);
        } else {
            recorder.recorded_in =
                find_free_name(options_of(app).files_folder, "palpa-session", {""});
            session.begin_recording(recorder.recorded_in, false, options_of(app).trajectory);
            recorder.warned_of_disk = false;
            tell(app, format_translated("recording into {}", recorder.recorded_in.string()));
        }
    });
}

std::string describe_recording(const World& app) {
    WindowSession& session = session_of(app);
    if (const auto state = session.recording()) {
        const std::string size = describe_bytes(state->bytes);
        if (!state->free_bytes) return size;
        return format_translated("{}, {} left", size, describe_bytes(*state->free_bytes));
    }
    const std::optional<double> share = session.packed_share();
    return share ? format_translated("compressing: {:.0f} %", 100 * *share) : std::string();
}

void finish_recording(WindowSession& session, const StageFunction& on_stage) {
    constexpr std::chrono::milliseconds between{20};
    if (session.recording()) session.end_recording();
    while (const std::optional<double> share = session.packed_share()) {
        tell(on_stage, for_translation("compressing"), share);
        std::this_thread::sleep_for(between);
    }
}

void tell_of_recording(World& app) {
    tell_recording_notes(app);
    tell_of_disk(app);
    tell_of_compression(app);
    tell_of_film(app);
    if (const std::vector<std::string> notes = session_of(app).take_server_notes(); !notes.empty())
        tell(app, fmt::format("{}", fmt::join(notes, "\n")));
}

void ask_for_export(World& app) {
    if (!has_frame(app)) return;
    const auto as = [&app](const char* ending) {
        return [&app, ending] { ask_what_to_export(app, ending); };
    };
    app.write<Dialogs>().question = {
        translated("Save the present coordinates as"),
        {{Key::P, "PDB (P)", as(".pdb")},
         {Key::C, "mmCIF (C)", as(".cif")},
         {Key::G, "GRO (G)", as(".gro")},
         {Key::S, translated("PSF and CRD (S)"), as(".psf")},
         {Key::V, translated("CSV of forces and marks (V)"), [&app] { export_readings(app); }},
         {Key::Escape, translated("Not (Esc)")}}};
}

}  // namespace palpa
