// What a person takes out of the window: coordinates and films.
#include "app/sandbox.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "session/coordinates.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// The first palpa-0001.pdb and so on that is free, with all that is written beside it.
std::filesystem::path next_file(const std::filesystem::path& folder, const std::string& ending) {
    for (int number = 1;; ++number) {
        std::filesystem::path path = folder / fmt::format("palpa-{:04}{}", number, ending);
        const auto is_taken = [](const std::filesystem::path& file) {
            std::error_code error;
            return std::filesystem::exists(file, error);
        };
        std::filesystem::path crd = path, frames = path;
        crd.replace_extension(".crd");
        frames += "-frames";
        if (!is_taken(path) && !is_taken(frames) && !(ending == ".psf" && is_taken(crd)))
            return path;
    }
}

}  // namespace

// As what, and then of what, where something is in hand.
void Sandbox::ask_for_export() {
    if (!has_frame_) return;
    const auto as = [this](const char* ending) {
        return [this, ending] { ask_what_to_export(ending); };
    };
    question_ = {
        translated("Save the present coordinates as"),
        {{Key::P, "PDB (P)", as(".pdb")},
         {Key::C, "mmCIF (C)", as(".cif")},
         {Key::G, "GRO (G)", as(".gro")},
         {Key::S, translated("PSF and CRD (S)"), as(".psf")},
         {Key::V, translated("CSV of forces and marks (V)"), [this] { export_readings(); }},
         {Key::Escape, translated("Not (Esc)")}}};
}

// The last seconds of the hand, and what the picture's marks say now.
void Sandbox::export_readings() {
    const std::filesystem::path file = next_file(options_.screenshots, ".csv");
    std::filesystem::path marks = file;
    marks.replace_filename(file.stem().string() + "-marks.csv");
    std::string text = "x_angstrom,y_angstrom,z_angstrom,label\n";
    for (const ViewLabel& label : frame_.labels) {
        std::string quoted;
        for (const char letter : label.text)
            quoted += letter == '"' ? "\"\"" : std::string(1, letter);
        text +=
            fmt::format("{},{},{},\"{}\"\n", label.place.x, label.place.y, label.place.z, quoted);
    }
    try {
        const std::array files{TextFile{file, format_readings(overlay_.history().samples())},
                               TextFile{marks, text}};
        write_text_files(files);
        notice(fmt::format("saved {} (the last {:.0f} s) and {} (the present marks)", file.string(),
                           History::seconds, marks.string()));
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
    }
}

void Sandbox::ask_what_to_export(const std::string& ending) {
    const std::string in_hand = molecule_in_hand();
    if (in_hand.empty()) return export_coordinates(ending, {});
    question_ = {translated("Save coordinates of"),
                 {{Key::A, translated("all that is shown (A)"),
                   [this, ending] { export_coordinates(ending, {}); }},
                  {Key::H, format_translated("{} in hand (H)", in_hand),
                   [this, ending, in_hand] { export_coordinates(ending, {in_hand}); }},
                  {Key::Escape, translated("Not (Esc)")}}};
}

void Sandbox::export_coordinates(const std::string& ending,
                                 const std::vector<std::string>& molecules) {
    try {
        const World world = session_.copy_world();
        const std::filesystem::path file = next_file(options_.screenshots, ending);
        const std::vector<std::uint32_t> atoms = select_atoms(world, molecules);
        write_text_files(format_coordinates(world, atoms, file, title_));
        notice(format_translated("saved {}: {} atoms", file.string(), atoms.size()));
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
    }
}

void Sandbox::film_or_end() {
    if (film_) {
        film_->end();
        return;
    }
    try {
        filmed_in_ = next_file(options_.screenshots, ".mp4");
        film_ = std::make_unique<FilmRecorder>(FilmSettings{.file = filmed_in_});
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
    }
}

// How far it is, and what became of it.
void Sandbox::tell_of_film() {
    if (!film_) return;
    constexpr double while_it_lasts_s = 1;
    if (const std::optional<std::string> outcome = film_->outcome()) {
        film_.reset();
        notice(*outcome, first_notice_s);
    } else if (film_->is_ended()) {
        notice(format_translated("writing {}: {} pictures left", filmed_in_.string(),
                                 film_->waiting()),
               while_it_lasts_s);
    } else {
        notice(format_translated("filming {}: {:.0f} s; press M to end", filmed_in_.string(),
                                 film_->filmed_s()),
               while_it_lasts_s);
    }
}

}  // namespace palpa
