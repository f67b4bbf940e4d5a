#include "session/recording.h"

#include "core/assertion.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/version.h"
#include "field/processor.h"
#include "formats/gzip.h"
#include "render/picture.h"
#include "scene/find_scene.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "session/accuracy_report.h"

#include <fmt/format.h>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::array columns = std::to_array<std::string_view>({"time_s",
                                                                "handle_x_m",
                                                                "handle_y_m",
                                                                "handle_z_m",
                                                                "molecule_x_angstrom",
                                                                "molecule_y_angstrom",
                                                                "molecule_z_angstrom",
                                                                "force_x_nN",
                                                                "force_y_nN",
                                                                "force_z_nN",
                                                                "torque_x_nN_angstrom",
                                                                "torque_y_nN_angstrom",
                                                                "torque_z_nN_angstrom",
                                                                "device_force_x_N",
                                                                "device_force_y_N",
                                                                "device_force_z_N",
                                                                "force_gain",
                                                                "displacement_gain",
                                                                "stiffness_N_per_m",
                                                                "hand_energy_J",
                                                                "potential_kcal_per_mol",
                                                                "active_joints",
                                                                "period_ms",
                                                                "clutch",
                                                                "handle_turn_x_rad",
                                                                "handle_turn_y_rad",
                                                                "handle_turn_z_rad",
                                                                "molecule_turn_x_rad",
                                                                "molecule_turn_y_rad",
                                                                "molecule_turn_z_rad",
                                                                "cap_N_per_m",
                                                                "waiting_m",
                                                                "clipped_m",
                                                                "at_stop",
                                                                "force_error_estimate_nN",
                                                                "model_age_angstrom"});

// The last two are there only where molecules relax.
constexpr std::size_t count_columns(bool relaxes) noexcept {
    return columns.size() - (relaxes ? 0 : 2);
}

// What all hands share.
constexpr bool is_common(std::string_view column) noexcept {
    return column == "time_s" || column == "period_ms";
}

// Of one hand, by column.
std::array<double, columns.size()> trace_values(const ServoTick& tick) {
    const DeviceReading& device = tick.reading;
    const ContactModel& contact = tick.contact;
    // Adding nothing makes -0 a plain 0.
    const Vec3 zero = Vec3::Zero();
    const Vec3 force_nN = contact.force_newton * 1e9 + zero;
    const Vec3 torque = contact.torque_newton_metre * 1e19 + zero;  // nN Å
    const Vec3 sent = tick.sent_newton + zero;
    const Vec3 molecule = contact.molecule.place_angstrom + zero;
    const Vec3 handle = device.position_m + zero;
    const Vec3 handle_turn = rotation_vector_of(device.orientation) + zero;
    const Vec3 molecule_turn = rotation_vector_of(contact.molecule.orientation) + zero;
    return {device.time_s,
            handle.x(),
            handle.y(),
            handle.z(),
            molecule.x(),
            molecule.y(),
            molecule.z(),
            force_nN.x(),
            force_nN.y(),
            force_nN.z(),
            torque.x(),
            torque.y(),
            torque.z(),
            sent.x(),
            sent.y(),
            sent.z(),
            tick.force_gain,
            contact.displacement_gain,
            contact.stiffness_N_per_m,
            tick.hand_energy_J,
            contact.potential_kcal_per_mol,
            static_cast<double>(contact.active_freedom),
            contact.period_s * 1e3,
            tick.clutched ? 1.0 : 0.0,
            handle_turn.x(),
            handle_turn.y(),
            handle_turn.z(),
            molecule_turn.x(),
            molecule_turn.y(),
            molecule_turn.z(),
            tick.cap_N_per_m,
            tick.waiting_m.norm(),
            tick.clipped_m.norm(),
            tick.is_at_stop ? 1.0 : 0.0,
            contact.error_estimate_newton * 1e9,
            contact.model_age_angstrom};
}

constexpr std::size_t flush_bytes = 1 << 16;

// Every file the scene names, each once.
std::vector<fs::path> input_files(const SceneDescription& scene) {
    std::vector<fs::path> files;
    const auto add = [&](const fs::path& file) {
        const bool is_new = std::find(files.begin(), files.end(), file) == files.end();
        if (is_new && !file.empty()) files.push_back(file);
    };
    for (const fs::path& file : scene.force_field.files) add(file);
    for (const MoleculeDescription& molecule : scene.molecules) {
        add(molecule.structure);
        add(molecule.topology);
    }
    for (EditDescription edit : scene.edits) {
        for (const fs::path* const file : list_files(edit.action)) add(*file);
    }
    return files;
}

// What a file is called in the recording: "inputs/NAME", numbered where a name is taken, and of
// letters that TOML and every file system take as they are.
std::string input_name(const fs::path& file, std::set<std::string>& taken) {
    std::string own = file.filename().string();
    for (char& c : own) {
        constexpr std::string_view plain = "-_.";
        const bool is_letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (!is_letter && plain.find(c) == std::string_view::npos) c = '_';
    }
    std::string name = own;
    for (int number = 2; !taken.insert(name).second; ++number) {
        name = fmt::format("{}-{}", number, own);
    }
    return "inputs/" + name;
}

std::map<fs::path, std::string> input_names(const std::vector<fs::path>& files,
                                            std::set<std::string>& taken) {
    std::map<fs::path, std::string> names;
    for (const fs::path& file : files) names[file] = input_name(file, taken);
    return names;
}

std::map<fs::path, std::string> input_names(const std::vector<fs::path>& files) {
    std::set<std::string> taken;
    return input_names(files, taken);
}

constexpr std::string_view session_mark = "# A recorded Palpa session";
constexpr std::string_view by_trajectory_mark =
    "# A recorded Palpa session, in which a trajectory moved the atoms";

constexpr std::string_view by_commands_mark = "# A recorded Palpa session, which commands drove";

// A line of session.toml: the version of the recording follows.
constexpr std::string_view version_mark = "# Recording format ";

// A part of the line before it: the instruction set of the kernels follows, and a full stop.
constexpr std::string_view kernels_mark = ", on a processor of kind ";

// What the head of a session says about running it again.
std::string describe_return(const SceneDescription& scene, RecordedBy by) {
    if (scene.engine) {
        return fmt::format(
            "{}, every field written out. A remote engine\n# moved the atoms, and its frames are "
            "not here: it cannot be played again.\n",
            session_mark);
    }
    switch (by) {
        case RecordedBy::Trajectory:
            return fmt::format(
                "{},\n# every field written out. Its frames are not here: it cannot be played "
                "again.\n",
                by_trajectory_mark);
        case RecordedBy::Commands:
            return fmt::format(
                "{},\n# every field written out. The commands are not here: to run it again, give "
                "them to\n#   palpa run session.toml --headless --commands --record NEW_FOLDER\n",
                by_commands_mark);
        case RecordedBy::Journal:
            return fmt::format(
                "{}, every field written out. To play what people did in it (journal.txt):\n#   "
                "palpa replay THIS_FOLDER\n",
                session_mark);
        default:
            return fmt::format(
                "{}, every field written out. To run it again, to the last digit:\n"
                "#   PALPA_KERNELS={} palpa run session.toml --headless --record NEW_FOLDER\n",
                session_mark, processor_kind());
    }
}

std::string format_session(const SceneDescription& scene, RecordedBy by = RecordedBy::Hand) {
    const std::map<fs::path, std::string> names = input_names(input_files(scene));
    return describe_return(scene, by) +
           format_scene(scene, [&](const fs::path& file) { return names.at(file); });
}

bool is_recording(const fs::path& folder) {
    return begins_with(folder / "session.toml", session_mark);
}

bool is_there(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

// The files in one of a recording's own folders; none where that is not there. A link to another
// folder is not followed.
std::vector<fs::path> list_own_folder(const fs::path& folder) {
    std::error_code error;
    if (!is_there(folder)) return {};
    if (!fs::is_directory(fs::symlink_status(folder, error))) {
        throw LoadError({folder.string()},
                        "is not a folder; expected the folder that the recording made");
    }
    return list_folder(folder);
}

// All that was written for the recording in a folder, and not what somebody put beside it: inputs
// are those that its session names, frames are numbered and ours.
std::vector<fs::path> list_recorded(const fs::path& folder) {
    const std::string session = read_text_file(folder / "session.toml");
    std::vector<fs::path> files;
    // A draft is left of a program that was killed while it compressed.
    for (const char* const name :
         {"summary.json", "trace.csv", "trace.csv.gz", "trace.csv.gz.draft", "journal.txt",
          "journal.txt.gz", "journal.txt.gz.draft"}) {
        const fs::path file = folder / name;
        std::error_code error;
        if (!is_there(file)) continue;
        if (!fs::is_regular_file(fs::symlink_status(file, error))) {
            throw LoadError({file.string()},
                            "is not a regular file; expected the file that the recording made");
        }
        files.push_back(file);
    }
    for (fs::path& file : list_trajectory_files(folder)) files.push_back(std::move(file));
    for (const fs::path& file : list_own_folder(folder / "inputs")) {
        const std::string name = fmt::format("\"inputs/{}\"", file.filename().string());
        if (session.find(name) != std::string::npos) files.push_back(file);
    }
    for (const fs::path& file : list_own_folder(folder / "frames")) {
        const std::string name = file.stem().string();
        const bool is_numbered =
            name.size() >= 4 && name.find_first_not_of("0123456789") == std::string::npos;
        if (is_numbered && has_mark(file, picture_mark)) files.push_back(file);
    }
    files.push_back(folder / "session.toml");  // last, since it names the others
    return files;
}

// By the nearest folder that is there.
void check_can_be_made(const fs::path& folder) {
    std::error_code error;
    fs::path parent = fs::absolute(folder, error).parent_path();
    while (parent.has_relative_path() && !fs::exists(parent, error)) parent = parent.parent_path();
    if (!fs::is_directory(parent, error)) {
        throw LoadError({folder.string()},
                        fmt::format("cannot be made: {} is not a folder", parent.string()));
    }
}

}  // namespace

bool is_of_trajectory(const fs::path& folder) {
    return begins_with(folder / "session.toml", by_trajectory_mark);
}

bool is_of_commands(const fs::path& folder) {
    return begins_with(folder / "session.toml", by_commands_mark);
}

bool has_journal(const fs::path& folder) {
    std::error_code error;
    return fs::exists(find_plain_or_packed(folder / journal_name), error);
}

// Recordings from before 1.0 do not state theirs.
constexpr FileVersion unstated_version{1, 0};

FileVersion read_recording_version(const fs::path& folder) {
    const fs::path session = folder / "session.toml";
    if (!is_there(session)) return unstated_version;
    const std::string text = read_text_file(session);
    std::size_t number = 0;
    for (const std::string_view line : split_lines(text)) {
        ++number;
        if (!line.starts_with(version_mark)) continue;
        const std::string_view stated = trimmed(line.substr(version_mark.size()));
        if (const auto version = find_version(stated)) return *version;
        throw LoadError({session.string(), number},
                        fmt::format("'{}' is not the number of a recording's format; expected {}",
                                    printable(stated.substr(0, 40)), to_string(recording_version)));
    }
    return unstated_version;
}

std::string read_recorded_kernels(const fs::path& folder) {
    const std::string text = read_text_file(folder / "session.toml");
    const std::size_t mark = text.rfind(kernels_mark);
    if (mark == std::string::npos) return {};
    const std::size_t begin = mark + kernels_mark.size();
    return text.substr(begin, text.find('.', begin) - begin);
}

SceneDescription read_recorded_scene(const fs::path& folder) {
    const fs::path session = folder / "session.toml";
    std::error_code error;
    if (!fs::exists(session, error)) {
        throw LoadError({folder.string()},
                        "has no session.toml; expected the folder of a recording (palpa run "
                        "--record)");
    }
    const std::optional<std::string> note = check_version(
        "recording", read_recording_version(folder), recording_version, {session.string()});
    SceneDescription scene = read_scene(session, {});
    if (note) scene.notes.push_back(fmt::format("{}: {}", session.string(), *note));
    if (scene.engine) {
        throw LoadError(scene.place_of("engine"),
                        "cannot be replayed: a remote engine moved the atoms and the recording "
                        "does not have its frames; expected a recording without [engine]");
    }
    if (is_of_trajectory(folder)) {
        throw LoadError({folder.string()},
                        "cannot be replayed: a trajectory moved the atoms (--trajectory) and the "
                        "recording does not have its frames; expected a recording without a "
                        "trajectory");
    }
    if (is_of_commands(folder)) {
        throw LoadError({folder.string()},
                        "cannot be replayed: commands drove the run (--commands) and the recording "
                        "does not have them; expected a recording without commands, or the same "
                        "commands given to palpa run session.toml --headless --commands");
    }
    return scene;
}

InputNames::InputNames(const SceneDescription& scene) {
    (void)input_names(input_files(scene), taken_);
}

std::string InputNames::add(const fs::path& file) { return input_name(file, taken_); }

void check_record_folder(const fs::path& folder, bool overwrites) {
    std::error_code error;
    if (!fs::exists(folder, error)) return check_can_be_made(folder);
    if (!fs::is_directory(folder, error)) {
        throw LoadError({folder.string()}, "is a file; expected a folder to record into");
    }
    if (fs::is_empty(folder, error)) return;
    if (!overwrites) {
        throw LoadError(
            {folder.string()},
            is_recording(folder)
                ? "already contains a recording; expected a new or empty folder, or --overwrite"
                : "contains files that are not a recording; expected a new or empty folder");
    }
    if (!is_recording(folder)) {
        throw LoadError({folder.string()},
                        "contains files that are not a recording and is not overwritten; expected "
                        "a new or empty folder");
    }
    (void)list_recorded(folder);
}

namespace {

// Before the first byte is written: what check_record_folder lets pass goes, but for the session,
// so that the folder remains a recording whatever happens. Throws before anything is gone where a
// file of somebody's has one of the new names.
void make_room(const fs::path& folder, const std::map<fs::path, std::string>& names) {
    std::error_code error;
    if (fs::is_empty(folder, error)) return;
    const fs::path session = folder / "session.toml";
    std::vector<fs::path> files = list_recorded(folder);
    for (const auto& [input, name] : names) {
        const fs::path file = folder / name;
        if (is_there(file) && std::find(files.begin(), files.end(), file) == files.end()) {
            throw LoadError(
                {file.string()},
                "is not part of this recording and is not replaced; expected a new folder");
        }
    }
    std::erase(files, session);
    for (const fs::path& file : files) {
        fs::remove(file, error);
        if (error) throw LoadError({file.string()}, "cannot be replaced: " + error.message());
    }
    for (const char* const name : {"inputs", "frames"})
        fs::remove(folder / name, error);  // if empty
}

nlohmann::ordered_json accuracy_as_json(const AccuracyReport& report) {
    nlohmann::ordered_json json;
    if (report.range_pN) {
        json["range_pN"] = *report.range_pN;
        json["ends_N"] = report.ends_newton;
    }
    json["stiffest_share_of_cap"] = report.stiffest_share;
    json["largest_cap_ratio"] = report.largest_cap_ratio;
    json["thermal_limit_share"] = report.thermal_share;
    if (report.within_pN) {
        json["within_pN"] = *report.within_pN;
        json["error_estimates"] = report.estimates;
        for (const auto& [key, value] : {std::pair{"error_median_pN", report.median_pN},
                                         {"error_90_pN", report.ninety_pN},
                                         {"within_share", report.within_share}})
            json[key] = report.estimates > 0 ? nlohmann::ordered_json(value) : nullptr;
        json["active_mean"] = report.active;
        json["steps_mean"] = report.steps;
    }
    json["not_met"] = find_unmet(report).all();
    return json;
}

// How one hand feels.
void add_coupling(const SceneDescription& scene, std::size_t hand, nlohmann::ordered_json& json) {
    const CouplingDescription& c = coupling_of(scene, hand);
    json["mode"] = coupling_mode_names[static_cast<std::size_t>(c.mode)];
    json["coupling"] = {
        {"clamp_N", c.clamp_N},         {"F_h1_N", c.F_h1_N},     {"F_h2_N", c.F_h2_N},
        {"F_0_nN", c.F_0_nN},           {"A_f_min", c.A_f_min},   {"A_f_max", c.A_f_max},
        {"gamma_per_N", c.gamma_per_N}, {"F_off_pN", c.F_off_pN}, {"A_d_min", c.A_d_min},
        {"A_d_max", c.A_d_max},         {"A_f", c.A_f},           {"A_d", c.A_d}};
    json["friction_N"] = device_of(scene, hand).friction_N;
}

// What one hand felt and did.
void add_felt(const Summary& hand, bool has_engine, nlohmann::ordered_json& json) {
    if (hand.ripple) {
        json["ripple_N"] = hand.ripple->rms;
        json["ripple_Hz"] = hand.ripple->hertz;
    } else {  // too short a run to tell
        json["ripple_N"] = json["ripple_Hz"] = nullptr;
    }
    json["net_work_J"] = hand.net_work_J;
    json["largest_felt_N"] = hand.largest_felt_N;
    if (hand.is_on_axis) {
        json["largest_attraction_N"] = hand.largest_attraction_N;
        json["largest_repulsion_N"] = hand.largest_repulsion_N;
    }
    // A spring to an engine's atoms is measured from no other molecule.
    if (has_engine) return;
    json["closest_angstrom"] = hand.closest_angstrom;
    json["last_angstrom"] = hand.last_angstrom;
}

nlohmann::ordered_json travel_as_json(const HandTravel& travel) {
    return {{"handle_m", travel.handle_m},
            {"lost_m", travel.lost_m},
            {"strokes", travel.strokes},
            {"at_stop_s", travel.at_stop_s}};
}

// What held its force back.
void add_safety(const Summary& hand, nlohmann::ordered_json& json) {
    json["travel"] = travel_as_json(hand.travel);
    json["clamped_share"] = hand.clamped_share;
    json["safety"] = hand.is_safety_full ? "full" : "paper";
    json["safety_share"] = hand.safety_share;
    json["stopped"] = hand.stopped;
}

}  // namespace

std::string scene_hash(const SceneDescription& scene) {
    std::uint64_t hash = content_hash(format_session(scene));
    for (const fs::path& file : input_files(scene)) {
        hash = content_hash(read_text_file(file), hash);
    }
    return fmt::format("{:016x}", hash);
}

std::string trace_header(std::size_t hands, bool relaxes) {
    const auto own = std::span(columns).first(count_columns(relaxes));
    std::string header = fmt::format("{}", fmt::join(own, ","));
    for (std::size_t hand = 2; hand <= hands; ++hand) {
        for (const std::string_view column : own) {
            if (!is_common(column)) header += fmt::format(",{}_{}", column, hand);
        }
    }
    return header;
}

std::string format_summary(const SceneDescription& scene, const Summary& summary) {
    nlohmann::ordered_json json;
    json["versions"] = {{"palpa", version_name},
                        {"commit", commit_name},
                        {"compiler", __VERSION__},
                        {"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                                              EIGEN_MINOR_VERSION)},
                        {"scene_format", to_string(scene_version)},
                        {"recording_format", to_string(recording_version)}};
    json["scene"] = scene.title;
    json["scene_hash"] = scene_hash(scene);
    json["device"] = summary.device;
    json["hand"] = grip_names[static_cast<std::size_t>(scene.hands.front().grip)];
    json["stroke"] = stroke_names[static_cast<std::size_t>(scene.hands.front().stroke)];
    add_coupling(scene, 0, json);
    json["period_ms"] = scene.period_ms;
    json["seed"] = scene.seed;
    json["seconds"] = static_cast<double>(summary.ticks) / servo_rate_hz;
    json["steps"] = summary.steps;
    json["step_median_us"] = summary.step_median_us;
    json["step_p99_us"] = summary.step_p99_us;
    json["steps_not_finite"] = summary.steps_not_finite;
    if (summary.client_pulls > 0) json["client_pulls"] = summary.client_pulls;
    add_felt(summary, scene.engine.has_value(), json);
    if (summary.activity) {
        json["active_mean"] = summary.activity->active;
        json["neglected_share"] = summary.activity->neglected_share;
        json["choices"] = summary.activity->choices;
        json["within_budget_share"] = summary.activity->within_budget;
    }
    if (summary.unbinding) {
        json["farthest_angstrom"] = summary.unbinding->farthest;
        json["clearance_angstrom"] = summary.unbinding->clearance;
        json["closest_atoms_angstrom"] = summary.unbinding->closest;
        if (summary.unbinding->free_s) json["free_s"] = *summary.unbinding->free_s;
        json["last_rmsd_angstrom"] = summary.unbinding->last_rmsd;
        json["last_backbone_rmsd_angstrom"] = summary.unbinding->last_backbone;
        json["last_pocket_rmsd_angstrom"] = summary.unbinding->last_pocket;
    }
    if (summary.relaxation) {
        const RelaxationSummary& r = *summary.relaxation;
        json["relaxation"] = {{"error_estimates", r.estimates},
                              {"error_median_pN", r.error_median_pN},
                              {"error_90_pN", r.error_90_pN},
                              {"renewals", r.renewals},
                              {"step_between_median_us", r.between_median_us},
                              {"step_between_90_us", r.between_90_us},
                              {"step_between_99_us", r.between_99_us},
                              {"step_renewal_median_us", r.renewal_median_us},
                              {"snaps", r.snaps},
                              {"released_kcal_per_mol", r.released}};
    }
    if (summary.engine) {
        const EngineReport& e = *summary.engine;
        json["engine"] = {{"frames", e.frames},
                          {"frames_per_s", e.frames_per_s},
                          {"delay_ms", 1e3 * e.delay_s},
                          {"interruptions", e.interruptions},
                          {"state", e.state}};
    }
    if (summary.accuracy) json["feel"] = accuracy_as_json(*summary.accuracy);
    add_safety(summary, json);
    json["overruns"] = summary.overruns;
    for (std::size_t i = 0; i < summary.other_hands.size(); ++i) {
        const Summary& hand = summary.other_hands[i];
        nlohmann::ordered_json& other = json[fmt::format("hand_{}", i + 2)];
        other["device"] = hand.device;
        other["hand"] = grip_names[static_cast<std::size_t>(scene.hands.at(i + 1).grip)];
        other["stroke"] = stroke_names[static_cast<std::size_t>(scene.hands.at(i + 1).stroke)];
        add_coupling(scene, i + 1, other);
        add_felt(hand, scene.engine.has_value(), other);
        if (hand.accuracy) other["feel"] = accuracy_as_json(*hand.accuracy);
        add_safety(hand, other);
    }
    json["neglected"] = summary.neglected;
    json["warnings"] = summary.warnings;
    return json.dump(2) + "\n";
}

Recording::Recording(const fs::path& folder, const SceneDescription& scene, bool overwrites,
                     std::size_t hands, RecordedBy by)
    : folder_(folder), scene_(scene), hands_(hands) {
    const std::vector<fs::path> files = input_files(scene);
    // Read everything before the first byte is written: the folder may hold the inputs themselves.
    std::vector<std::string> contents;
    for (const fs::path& file : files) contents.push_back(read_text_file(file));
    make_folder(folder);
    lock_.emplace(folder);
    check_record_folder(folder, overwrites);
    const std::map<fs::path, std::string> names = input_names(files);
    make_room(folder, names);
    // The trace first: where it cannot be written, nothing is.
    trace_.emplace(folder / "trace.csv");
    if (by == RecordedBy::Journal) journal_.emplace(folder / "journal.txt");
    rows_ = trace_header(hands, scene.has_statics()) + "\n";
    flush();
    std::error_code error;
    fs::create_directory(folder / "inputs", error);
    if (error) throw LoadError({folder.string()}, "cannot be written: " + error.message());
    write_text_file(folder / "session.toml",
                    fmt::format("{}# Recorded by Palpa {}, {}{}{}.\n{}{}\n",
                                format_session(scene, by), version_name, commit_name, kernels_mark,
                                processor_kind(), version_mark, to_string(recording_version)),
                    is_there(folder / "session.toml") ? Existing::Replace : Existing::Refuse);
    for (std::size_t i = 0; i < files.size(); ++i) {
        write_text_file(folder / names.at(files[i]), contents[i]);
    }
}

std::string trace_row(std::span<const ServoTick> ticks, bool relaxes) {
    std::string row;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        const std::array<double, columns.size()> values = trace_values(ticks[i]);
        for (std::size_t k = 0; k < count_columns(relaxes); ++k) {
            if (i > 0 && is_common(columns[k])) continue;
            if (!row.empty()) row += ',';
            fmt::format_to(std::back_inserter(row), "{}", values[k]);
        }
    }
    return row + "\n";
}

void Recording::add(std::span<const ServoTick> ticks) {
    PALPA_ASSERT(ticks.size() == hands_);
    if (tick_++ % static_cast<std::uint64_t>(scene_.every) != 0) return;
    rows_ += trace_row(ticks, scene_.has_statics());
    if (rows_.size() > flush_bytes) flush();
}

void Recording::add_journal(const std::string& text) {
    PALPA_ASSERT(journal_);
    journal_->write(text);
}

// The session names it as one of its own, for who replaces the recording.
void Recording::add_input(const std::string& name, const std::string& content) {
    write_text_file(folder_ / name, content);
    const fs::path session = folder_ / "session.toml";
    write_text_file(session,
                    fmt::format("{}# Added while it ran: \"{}\"\n", read_text_file(session), name),
                    Existing::Replace);
}

void Recording::begin_trajectory(const TrajectorySettings& settings) {
    trajectory_.emplace(folder_, settings);
    sampler_.emplace(settings.per_second);
}

void Recording::add_frame(const TrajectoryShot& shot) {
    if (trajectory_) trajectory_->add(shot);
}

void Recording::sample(const World& world, double time_s, std::uint64_t edition) {
    if (!sampler_) return;
    if (const auto shot = sampler_->take(world, time_s, edition)) add_frame(*shot);
}

std::vector<std::string> Recording::take_notes() {
    return trajectory_ ? trajectory_->take_notes() : std::vector<std::string>();
}

void Recording::finish(const Summary& summary) {
    flush();
    if (trajectory_) trajectory_->close();
    write_text_file(folder_ / "summary.json", format_summary(scene_, summary));
}

void Recording::flush() {
    if (trace_) trace_->write(rows_);
    rows_.clear();
}

}  // namespace palpa
