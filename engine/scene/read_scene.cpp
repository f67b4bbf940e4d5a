#include "scene/read_scene.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "scene/fields.h"
#include "scene/find_scene.h"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

namespace palpa {
namespace {

namespace fs = std::filesystem;

struct Problem {
    TextPlace place;
    std::string what;
};

// ---- where a node stands ---------------------------------------------------------------------

TextPlace place_of(const toml::source_region& source) {
    TextPlace place{source.path ? *source.path : "", source.begin.line, source.begin.column};
    if (place.file.starts_with("--set ")) place.line = place.column = 0;  // the command line
    return place;
}

// What a message quotes of a word that may be as long as the file.
std::string quote_word(std::string_view text) {
    constexpr std::size_t most = 80;
    return fmt::format("\"{}\"{}", text.substr(0, most), text.size() > most ? "..." : "");
}

// What a node holds, as a person would call it.
std::string kind_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "a list";
        case toml::node_type::string:
            return "the text " + quote_word(node.ref<std::string>());
        case toml::node_type::integer:
            return fmt::format("{}", node.ref<std::int64_t>());
        case toml::node_type::floating_point:
            return format_real(node.ref<double>());
        case toml::node_type::boolean:
            return node.ref<bool>() ? "true" : "false";
        case toml::node_type::none:
            break;
        default:
            return "a date or time";
    }
    return "nothing";
}

// ---- which files a scene may name --------------------------------------------------------------

// Where links lead.
fs::path real_path(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    const fs::path real = fs::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal() : real;
}

bool is_below(const fs::path& path, const fs::path& folder) {
    return std::mismatch(path.begin(), path.end(), folder.begin(), folder.end()).second ==
           folder.end();
}

// ---- reading ---------------------------------------------------------------------------------

// Fills a description from a table. Problems are gathered, so that the first one in the file is
// told and not the first one in our list.
class Reader final : public FieldVisitor {
public:
    Reader(const toml::table& root, fs::path file, bool allows_outside)
        : file_(std::move(file)), folder_(file_.parent_path()), is_made_(root.contains("made_by")) {
        if (!allows_outside) {
            may_read_ = {real_path(folder_.empty() ? "." : folder_)};
            for (const fs::path& folder : own_scene_folders()) {
                may_read_.push_back(real_path(folder));
            }
        }
        levels_.push_back({&root, "", place_or_start(root), {}, false});
    }

    // Throws what was found, or gives the places of all fields that the file has.
    std::map<std::string, TextPlace, std::less<>> finish() {
        report_unknown_keys(levels_.back());
        if (problems_.empty()) return std::move(places_);
        std::stable_sort(problems_.begin(), problems_.end(),
                         [](const Problem& a, const Problem& b) {
                             return std::tie(a.place.line, a.place.column) <
                                    std::tie(b.place.line, b.place.column);
                         });
        const std::size_t others = problems_.size() - 1;
        throw LoadError(
            problems_[0].place,
            problems_[0].what + (others == 0   ? ""
                                 : others == 1 ? " (and 1 more problem)"
                                               : fmt::format(" (and {} more problems)", others)));
    }

    void problem(const TextPlace& place, std::string what) {
        problems_.push_back({place, std::move(what)});
    }
    void problem(const toml::node& node, std::string what) {
        problem(place_of(node.source()), std::move(what));
    }

    // The place of a field that was read, or of the table where it should be.
    TextPlace place_of_key(const std::string& key) const {
        auto found = places_.find(key);
        if (found == places_.end()) found = places_.find(key.substr(0, key.rfind('.')));
        return found == places_.end() ? TextPlace{file_.string(), 1, 1} : found->second;
    }

    void enter_table(const Field& field) override {
        Level level{
            nullptr, full_key(field.key) + ".", levels_.back().place, {}, levels_.back().missing};
        if (const toml::node* const node = find(field)) {
            level.table = node->as_table();
            level.place = place_of(node->source());
            if (!level.table) {
                problem(*node,
                        fmt::format("'{}' is {}; expected a table, [{}]", full_key(field.key),
                                    kind_of(*node), full_key(field.key)));
                level.missing = true;
            }
        } else if (field.required && !level.missing) {
            problem(levels_.back().place,
                    fmt::format("no table [{}]: {}", full_key(field.key), field.meaning));
            level.missing = true;  // one message is enough for all that it would hold
        }
        levels_.push_back(std::move(level));
    }

    void leave_table() override {
        report_unknown_keys(levels_.back());
        levels_.pop_back();
    }

    void list_tables(const Field& field, std::vector<std::string>& names) override {
        names.clear();
        Level& level = levels_.back();
        if (!level.table) return;
        std::vector<std::pair<toml::source_position, std::string>> found;
        for (const auto& [key, node] : *level.table) {
            found.emplace_back(node.source().begin, std::string(key.str()));
        }
        std::stable_sort(found.begin(), found.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (auto& [position, name] : found) names.push_back(std::move(name));
        if (names.empty()) {
            problem(level.place,
                    fmt::format("[{}] holds no table; expected {}",
                                level.path.substr(0, level.path.size() - 1), field.meaning));
        }
    }

    void real(const Field& field, double& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        if (!node->is_number()) {
            return problem(*node, expected(field, *node, "a number"));
        }
        const double read = node->is_integer() ? static_cast<double>(node->ref<std::int64_t>())
                                               : node->ref<double>();
        if (!std::isfinite(read)) return problem(*node, expected(field, *node, "a finite number"));
        const bool is_zero = read == 0 && field.zero;
        if (!is_zero && (read < field.lowest || read > field.highest)) {
            return problem(*node, expected(field, *node, range(field, "a number")));
        }
        value = read;
    }

    void optional_real(const Field& field, std::optional<double>& value) override {
        double read = NAN;
        real(field, read);
        if (!std::isnan(read)) value = read;
    }

    void optional_pair(const Field& field, std::optional<std::array<double, 2>>& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        if (const auto read = find_numbers<2>(field, *node)) {
            value = *read;
        } else {
            problem(*node, expected(field, *node,
                                    fmt::format("two numbers from {} to {}, [20.0, 3000.0]",
                                                field.lowest, field.highest)));
        }
    }

    void triple(const Field& field, std::array<double, 3>& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        if (const auto read = find_numbers<3>(field, *node)) {
            value = *read;
        } else {
            problem(*node, expected(field, *node,
                                    fmt::format("three numbers from {} to {}, [0.0, 1.0, 2.0]",
                                                field.lowest, field.highest)));
        }
    }

    void flag(const Field& field, bool& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        if (!node->is_boolean()) return problem(*node, expected(field, *node, "true or false"));
        value = node->ref<bool>();
    }

    void integer(const Field& field, std::int64_t& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        const std::int64_t read = node->value_exact<std::int64_t>().value_or(0);
        const auto real_value = static_cast<double>(read);
        if (!node->is_integer() || real_value < field.lowest || real_value > field.highest) {
            return problem(*node, expected(field, *node, range(field, "a whole number")));
        }
        value = read;
    }

    void text(const Field& field, std::string& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        if (!node->is_string()) return problem(*node, expected(field, *node, "text in quotes"));
        if (field.required && node->ref<std::string>().empty()) {
            return problem(*node, expected(field, *node, "text that is not empty"));
        }
        value = node->ref<std::string>();
    }

    void texts(const Field& field, std::vector<std::string>& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        const toml::array* const list = node->as_array();
        if (!list) return problem(*node, expected(field, *node, "a list of texts, [\"...\"]"));
        value.clear();
        for (const toml::node& entry : *list) {
            if (!entry.is_string()) {
                return problem(entry, fmt::format("an entry of '{}' is {}; expected text in quotes",
                                                  full_key(field.key), kind_of(entry)));
            }
            value.push_back(entry.ref<std::string>());
        }
    }

    void choice(const Field& field, std::span<const std::string_view> names,
                std::size_t& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        const std::string read = node->is_string()    ? node->ref<std::string>()
                                 : node->is_integer() ? fmt::format("{}", node->ref<std::int64_t>())
                                                      : "";
        const auto found = std::find(names.begin(), names.end(), read);
        if (found == names.end()) {
            return problem(*node, expected(field, *node,
                                           fmt::format("one of {}{}", fmt::join(names, ", "),
                                                       near_name_hint(read, names))));
        }
        value = static_cast<std::size_t>(found - names.begin());
    }

    void optional_choice(const Field& field, std::span<const std::string_view> names,
                         std::optional<std::size_t>& value) override {
        std::size_t read = names.size();
        choice(field, names, read);
        if (read < names.size()) value = read;
    }

    void file(const Field& field, fs::path& value) override {
        const toml::node* const node = find_value(field);
        if (node) read_file_name(field, *node, value);
    }

    void files(const Field& field, std::vector<fs::path>& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        const toml::array* const list = node->as_array();
        if (!list || list->empty()) {
            return problem(*node, expected(field, *node, "a list of file names, [\"...\"]"));
        }
        value.clear();
        for (const toml::node& entry : *list) {
            if (fs::path path; read_file_name(field, entry, path)) value.push_back(path);
        }
    }

    void path(const Field& field, std::vector<PathPoint>& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        const toml::array* const list = node->as_array();
        if (!list) return problem(*node, expected(field, *node, "a list of points, [[0.0, 1.0]]"));
        value.clear();
        for (const toml::node& entry : *list) {
            const std::optional<PathPoint> point = find_path_point(field, entry);
            if (!point) {
                return problem(
                    entry, fmt::format("an entry of '{}' is no point of a path; expected [s, mm], "
                                       "[s, mm, mm, mm] or [s, mm, mm, mm, degrees, degrees, "
                                       "degrees], numbers from {} to {}",
                                       full_key(field.key), field.lowest, field.highest));
            }
            value.push_back(*point);
        }
    }

private:
    // One table under way. `table` is null where the file has none: defaults, or errors.
    struct Level {
        const toml::table* table;
        std::string path;  // "molecules.fixed."
        TextPlace place;
        std::vector<std::string> known;  // keys that were asked for
        bool missing;                    // told already
    };

    // A list of so many numbers in the field's range.
    template <std::size_t Count>
    static std::optional<std::array<double, Count>> find_numbers(const Field& field,
                                                                 const toml::node& node) {
        const toml::array* const list = node.as_array();
        if (!list || list->size() != Count) return std::nullopt;
        std::array<double, Count> numbers{};
        for (std::size_t i = 0; i < Count; ++i) {
            const std::optional<double> number = list->get(i)->value<double>();
            if (!number || !(*number >= field.lowest && *number <= field.highest))
                return std::nullopt;
            numbers[i] = *number;
        }
        return numbers;
    }

    static std::optional<PathPoint> find_path_point(const Field& field, const toml::node& node) {
        const toml::array* const numbers = node.as_array();
        if (!numbers || (numbers->size() != 2 && numbers->size() != 4 && numbers->size() != 7))
            return std::nullopt;
        std::array<double, 7> all{};
        for (std::size_t i = 0; i < numbers->size(); ++i) {
            const std::optional<double> number = numbers->get(i)->value<double>();
            if (!number || !(*number >= field.lowest && *number <= field.highest))
                return std::nullopt;
            all[i] = *number;
        }
        return PathPoint{all[0], {all[1], all[2], all[3]}, {all[4], all[5], all[6]}};
    }

    TextPlace place_or_start(const toml::table& table) const {
        TextPlace place = place_of(table.source());
        place.file = file_.string();
        place.line = std::max<std::size_t>(place.line, 1);
        place.column = std::max<std::size_t>(place.column, 1);
        return place;
    }

    std::string full_key(std::string_view key) const {
        return levels_.back().path + std::string(key);
    }

    const toml::node* find(const Field& field) {
        Level& level = levels_.back();
        level.known.emplace_back(field.key);
        const toml::node* const node = level.table ? level.table->get(field.key) : nullptr;
        if (node) places_[full_key(field.key)] = place_of(node->source());
        return node;
    }

    // The node of a field that is no table; tells of a required one that is not there.
    const toml::node* find_value(const Field& field) {
        const toml::node* const node = find(field);
        const Level& level = levels_.back();
        if (!node && field.required && !level.missing) {
            problem(level.place,
                    fmt::format("no key '{}': {}", full_key(field.key), field.meaning));
        }
        return node;
    }

    std::string expected(const Field& field, const toml::node& node, std::string_view right) const {
        return fmt::format("'{}' is {}; expected {}", full_key(field.key), kind_of(node), right);
    }

    static std::string range(const Field& field, std::string_view kind) {
        return fmt::format("{} {}from {} to {}", kind, field.zero ? "that is 0, or " : "",
                           field.lowest, field.highest);
    }

    bool read_file_name(const Field& field, const toml::node& node, fs::path& value) {
        if (!node.is_string() || node.ref<std::string>().empty()) {
            problem(node, expected(field, node, "a file name in quotes"));
            return false;
        }
        value = folder_ / node.ref<std::string>();
        const fs::path real = real_path(value);
        if (!may_read_.empty() && std::ranges::none_of(may_read_, [&](const fs::path& folder) {
                return is_below(real, folder);
            })) {
            problem(node, fmt::format("'{}' names {}, which is outside of the scene's folder; "
                                      "expected a file below it, or --allow-outside where the "
                                      "scene is trusted",
                                      full_key(field.key), quote_word(node.ref<std::string>())));
            return false;
        }
        std::error_code error;
        if (fs::is_regular_file(value, error)) return true;
        problem(node, fmt::format("'{}' names no file: {} is not there; expected a file beside the "
                                  "scene{}",
                                  full_key(field.key), value.generic_string(),
                                  is_made_ ? ", whose made_by tells how it is made" : ""));
        return false;
    }

    void report_unknown_keys(const Level& level) {
        if (!level.table) return;
        const std::vector<std::string_view> known(level.known.begin(), level.known.end());
        for (const auto& [key, node] : *level.table) {
            if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
            const TextPlace place = place_of(key.source());
            const std::string name = level.path + std::string(key.str());
            const std::string hint = near_name_hint(key.str(), known);
            problem(place, fmt::format("unknown key '{}'{}", name,
                                       hint.empty() ? fmt::format("; expected one of {}",
                                                                  fmt::join(known, ", "))
                                                    : hint));
        }
    }

    fs::path file_, folder_;
    std::vector<fs::path> may_read_;  // folders, links resolved; empty: everything
    bool is_made_;                    // the scene says how its files are made
    std::vector<Level> levels_;
    std::vector<Problem> problems_;
    std::map<std::string, TextPlace, std::less<>> places_;  // by full key
};

// ---- what fields must be together ------------------------------------------------------------

std::string_view name_of(Motion motion) { return motion_names[static_cast<std::size_t>(motion)]; }

// The molecule that a field names; null where the problem is told.
const MoleculeDescription* find_named(const SceneDescription& scene, Reader& reader,
                                      const std::string& key, const std::string& name) {
    if (name.empty()) return nullptr;  // told already
    std::vector<std::string_view> names;
    for (const MoleculeDescription& molecule : scene.molecules) {
        if (molecule.name == name) return &molecule;
        names.emplace_back(molecule.name);
    }
    reader.problem(reader.place_of_key(key),
                   fmt::format("'{}' is \"{}\", which is no molecule of this scene; "
                               "expected one of {}{}",
                               key, name, fmt::join(names, ", "), near_name_hint(name, names)));
    return nullptr;
}

// Whether the hand can do something with the molecule.
bool check_grabbed(const SceneDescription& scene, const MoleculeDescription& grabbed,
                   Reader& reader) {
    const bool by_spring = !scene.grab.atom.empty();
    const bool yields = grabbed.motion == Motion::Free ||
                        (grabbed.motion == Motion::Fixed && grabbed.shape == Shape::Flexible);
    const bool is_moved = grabbed.motion == Motion::AlongX || grabbed.motion == Motion::Translate ||
                          grabbed.motion == Motion::TranslateAndTurn ||
                          grabbed.motion == Motion::WithHandle;
    if (by_spring ? yields : is_moved) return true;
    reader.problem(
        reader.place_of_key("grab.molecule"),
        fmt::format("'grab.molecule' is \"{}\", whose motion is \"{}\"; expected {}",
                    scene.grab.molecule, name_of(grabbed.motion),
                    by_spring ? "a free molecule, or one that is fixed and flexible: the hand "
                                "pulls at it by a spring (grab.atom)"
                              : "a molecule that moves, along-x, translate, translate-and-turn "
                                "or with-handle"));
    return false;
}

void check_start(const SceneDescription& scene, bool along_x, Reader& reader) {
    const bool has_offset = scene.hand.start_offset_angstrom != std::array<double, 3>{};
    if (along_x && has_offset) {
        reader.problem(reader.place_of_key("hand.start_offset_angstrom"),
                       "'hand.start_offset_angstrom' is for a molecule that moves in space; "
                       "expected hand.start_angstrom");
    }
    if (!along_x && scene.hand.start_angstrom) {
        reader.problem(reader.place_of_key("hand.start_angstrom"),
                       "'hand.start_angstrom' is for a molecule that moves along x; expected "
                       "hand.start_offset_angstrom");
    }
}

void check_grab(const SceneDescription& scene, Reader& reader) {
    const MoleculeDescription* const origin =
        find_named(scene, reader, "grab.measured_from", scene.grab.measured_from);
    if (origin && origin->motion != Motion::Fixed) {
        reader.problem(
            reader.place_of_key("grab.measured_from"),
            fmt::format("'grab.measured_from' is \"{}\", whose motion is \"{}\"; expected a "
                        "fixed molecule",
                        scene.grab.measured_from, name_of(origin->motion)));
    }
    // Without the right molecule in hand, what the others do is no problem of its own.
    const MoleculeDescription* const grabbed =
        find_named(scene, reader, "grab.molecule", scene.grab.molecule);
    if (!grabbed || !check_grabbed(scene, *grabbed, reader)) return;
    check_start(scene, grabbed->motion == Motion::AlongX, reader);
    for (const MoleculeDescription& molecule : scene.molecules) {
        const std::string key = "molecules." + molecule.name + ".motion";
        const bool by_itself = molecule.motion == Motion::Fixed || molecule.motion == Motion::Free;
        if (!by_itself && &molecule != grabbed) {
            reader.problem(
                reader.place_of_key(key),
                fmt::format("'{}' is \"{}\", but the hand moves only grab.molecule; expected "
                            "fixed or free",
                            key, name_of(molecule.motion)));
        }
        if (molecule.motion == Motion::AlongX && scene.has_statics()) {
            reader.problem(reader.place_of_key(key),
                           fmt::format("'{}' is \"along-x\" beside something that moves by "
                                       "itself; expected translate or translate-and-turn",
                                       key));
        }
        if (molecule.motion == Motion::WithHandle && scene.has_statics()) {
            reader.problem(reader.place_of_key(key),
                           fmt::format("'{}' is \"with-handle\" beside something that moves by "
                                       "itself, which a handle does not turn yet; expected "
                                       "translate or translate-and-turn",
                                       key));
        }
    }
    if (!scene.joints.around.empty())
        find_named(scene, reader, "joints.around", scene.joints.around);
}

void check_view(const ViewDescription& view, const SceneDescription& scene, Reader& reader) {
    find_named(scene, reader, "view.look_at", view.look_at);
    const auto [azimuth, elevation, zoom] = view.camera;
    if (std::abs(elevation) <= 90 && zoom >= 0.01 && zoom <= 100) return;
    reader.problem(
        reader.place_of_key("view.camera"),
        fmt::format("'view.camera' is [{}, {}, {}]; expected [azimuth, elevation, zoom]: "
                    "degrees, the second from -90 to 90, and a factor from 0.01 to 100",
                    azimuth, elevation, zoom));
}

void check_ranges(const SceneDescription& scene, Reader& reader) {
    const auto check = [&](bool right, const std::string& key, const std::string& what) {
        if (!right) reader.problem(reader.place_of_key(key), what);
    };
    const CouplingDescription& c = scene.coupling;
    check(
        c.F_h2_N > c.F_h1_N, "coupling.F_h2_N",
        fmt::format("'coupling.F_h2_N' is {}; expected more than F_h1_N, {}", c.F_h2_N, c.F_h1_N));
    check(c.A_d_max >= c.A_d_min, "coupling.A_d_max",
          fmt::format("'coupling.A_d_max' is {}; expected A_d_min, {}, or more", c.A_d_max,
                      c.A_d_min));
    check(c.F_hi_nN * 1e3 > 2 * c.F_lo_pN, "coupling.F_hi_nN",
          fmt::format("'coupling.F_hi_nN' is {}; expected more than twice F_lo_pN, {}", c.F_hi_nN,
                      c.F_lo_pN));
    if (const auto range = c.feel_pN) {
        constexpr double most_felt_newton = 3;
        const auto [weakest, strongest] = *range;
        check(strongest > weakest, "coupling.feel_pN",
              fmt::format("'coupling.feel_pN' is [{}, {}]; expected the weaker force first",
                          weakest, strongest));
        check(c.mode == CouplingMode::Guarded, "coupling.feel_pN",
              fmt::format("'coupling.feel_pN' is for guarded coupling, and coupling.mode is {}, "
                          "with forces of its own; expected mode = \"guarded\", or no feel_pN",
                          coupling_mode_names[static_cast<std::size_t>(c.mode)]));
        check(c.clamp_N >= most_felt_newton, "coupling.clamp_N",
              fmt::format("'coupling.clamp_N' is {}, and what feel_pN names is felt as up to {} N; "
                          "expected that or more",
                          c.clamp_N, most_felt_newton));
    }
    check(!c.feel_within_pN || !scene.has_statics() ||
              scene.statics.method == StaticsMethod::QuasiStatic,
          "statics.method",
          fmt::format("'statics.method' is \"{}\", which moves all joints at once; expected "
                      "quasi-static with coupling.feel_within_pN",
                      statics_method_names[static_cast<std::size_t>(scene.statics.method)]));
    check(std::abs(scene.period_ms - std::round(scene.period_ms)) < 1e-9, "run.period_ms",
          fmt::format("'run.period_ms' is {}; expected a whole number of servo ticks of 1 ms",
                      scene.period_ms));
    const HandDescription& h = scene.hand;
    check(h.stroke != Stroke::InOut || h.grip != 0, "hand.stroke",
          "'hand.stroke' is \"in-out\" with a grip of \"none\": nobody would move the handle; "
          "expected \"hold\", or a hand");
    const bool has_path = h.stroke == Stroke::Path || h.stroke == Stroke::Lead;
    check(!has_path || !h.path.empty(), "hand.stroke",
          fmt::format("'hand.stroke' is \"{}\", but 'hand.path' has no point; expected [[time, "
                      "place], ...]",
                      stroke_names[static_cast<std::size_t>(h.stroke)]));
    check(h.stroke != Stroke::Lead || h.grip != 0, "hand.stroke",
          "'hand.stroke' is \"lead\" with a grip of \"none\": nobody would move the handle; "
          "expected a hand");
    const auto turns = [](const PathPoint& point) {
        return point.turn_deg != PathPoint{}.turn_deg;
    };
    check(h.stroke != Stroke::Lead || std::ranges::none_of(h.path, turns), "hand.path",
          "'hand.path' turns the handle, but 'hand.stroke' is \"lead\", which only moves; expected "
          "[s, Å] or [s, Å, Å, Å]");
    for (std::size_t i = 1; i < h.path.size(); ++i) {
        check(h.path[i].time_s > h.path[i - 1].time_s, "hand.path",
              fmt::format("'hand.path' has the time {} after {}; expected ascending times",
                          h.path[i].time_s, h.path[i - 1].time_s));
    }
    for (const LessonStepDescription& step : scene.lesson) {
        const std::string key = "lesson." + step.name;
        check(step.at_least || step.at_most, key,
              fmt::format("'{}' has neither at_least nor at_most; expected one or both", key));
        check(!(step.at_least && step.at_most) || *step.at_least <= *step.at_most, key + ".at_most",
              fmt::format("'{}.at_most' is below at_least; no value would do", key));
    }
}

// ---- before reading ---------------------------------------------------------------------------

// The TOML reader follows dotted keys by recursion, without a limit of its own.
void check_dots(std::string_view line, const TextPlace& place) {
    constexpr std::ptrdiff_t most = 100;
    if (std::count(line.begin(), line.end(), '.') > most) {
        throw LoadError(place, fmt::format("more than {} dots in one line", most));
    }
}

// ---- settings from the command line ----------------------------------------------------------

// The full key that "mode" or "coupling.mode" means.
std::string full_setting_key(const std::string& key, const TextPlace& place) {
    if (key.find('.') != std::string::npos) return key;
    std::vector<std::string> matches;
    std::vector<std::string_view> last_parts;
    const std::vector<FieldNote> fields = list_fields();
    for (const FieldNote& field : fields) {
        const std::string_view last = std::string_view(field.key).substr(field.key.rfind('.') + 1);
        last_parts.push_back(last);
        if (field.key == key) return key;
        if (field.key.starts_with(key + ".")) {
            throw LoadError(
                place, fmt::format("'{}' is a table; expected one of its keys, such as {}", key,
                                   field.key));
        }
        if (last == key) matches.push_back(field.key);
    }
    // A field of NAME is one of every molecule, one of STEP one of every step of the lesson.
    const auto is_of_many = [](const std::string& field) {
        return field.find("NAME") != std::string::npos || field.find("STEP") != std::string::npos;
    };
    if (matches.size() == 1 && !is_of_many(matches[0])) return matches[0];
    if (matches.empty()) {
        throw LoadError(place, fmt::format("no field of a scene is called '{}'{}", key,
                                           near_name_hint(key, last_parts)));
    }
    throw LoadError(place, fmt::format("'{}' could be {}; expected the key in full", key,
                                       fmt::join(matches, " or ")));
}

// Lays `from` over `onto`, table by table. Moves, since copies of a node forget where they stood.
void merge(toml::table from, toml::table& onto) {
    for (auto&& [key, node] : from) {
        toml::table* const inner = node.as_table();
        toml::node* const old = onto.get(key.str());
        if (inner && old && old->is_table()) {
            merge(std::move(*inner), *old->as_table());
        } else {
            node.visit([&, &k = key](auto& value) { onto.insert_or_assign(k, std::move(value)); });
        }
    }
}

// The value of a setting as TOML: as it stands, or what a person means by .5 and by a bare word.
std::string setting_value(std::string_view text, const TextPlace& place) {
    const auto is_toml = [](const std::string& value) {
        try {
            (void)toml::parse(std::string_view(value));
            return true;
        } catch (const toml::parse_error&) {
            return false;
        }
    };
    std::string value(text);
    if (is_toml("x = " + value)) return value;
    if (const std::optional<double> number = find_real(text)) return format_real(*number);
    if (text.empty() || text.find_first_of("\"'\\[]{}=#") != std::string_view::npos) {
        throw LoadError(place, "the value is neither TOML nor a bare word");
    }
    return "\"" + value + "\"";
}

void apply_setting(const std::string& setting, toml::table& root) {
    const bool printable = std::none_of(setting.begin(), setting.end(), [](char letter) {
        return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f;
    });
    if (!printable) throw LoadError({"--set"}, "a setting is one line of printable text");
    const TextPlace place{"--set " + setting};
    check_dots(setting, place);
    const std::size_t equals = setting.find('=');
    const std::string left(trimmed(std::string_view(setting).substr(0, equals)));
    if (equals == std::string::npos || left.empty()) {
        throw LoadError(place, "expected KEY=VALUE, such as coupling.mode=2");
    }
    const std::string key = full_setting_key(left, place);
    if (key.starts_with('.') || key.ends_with('.') || key.find("..") != std::string::npos) {
        throw LoadError(place, fmt::format("'{}' is no key", key));
    }
    const std::string value =
        setting_value(trimmed(std::string_view(setting).substr(equals + 1)), place);
    try {
        merge(toml::parse(std::string_view(key + " = " + value), std::string_view(place.file)),
              root);
    } catch (const toml::parse_error&) {
        throw LoadError(place, fmt::format("'{}' is no key", key));
    }
}

}  // namespace

SceneDescription parse_scene(std::string_view text, const fs::path& file,
                             std::span<const std::string> settings) {
    std::size_t line_number = 0;
    for (const std::string_view line : split_lines(text)) {
        check_dots(line, {file.string(), ++line_number, 1});
    }
    toml::table root;
    try {
        root = toml::parse(text, std::string_view(file.string()));
    } catch (const toml::parse_error& error) {
        std::string what(error.description());
        if (!what.empty() && what[0] >= 'A' && what[0] <= 'Z') what[0] += 'a' - 'A';
        throw LoadError(place_of(error.source()), what);
    }
    if (root.empty()) {
        throw LoadError({file.string(), 1, 1},
                        "an empty scene; expected [force_field], [molecules.NAME] and [grab]");
    }
    bool allows_outside = false;
    for (const std::string& setting : settings) {
        if (setting == allow_outside) {
            allows_outside = true;
        } else {
            apply_setting(setting, root);
        }
    }

    SceneDescription scene;
    scene.file = file;
    Reader reader(root, file, allows_outside);
    visit_scene(reader, scene);
    check_grab(scene, reader);
    check_ranges(scene, reader);
    check_view(scene.view, scene, reader);
    scene.places = reader.finish();
    return scene;
}

SceneDescription read_scene(const fs::path& path, std::span<const std::string> settings) {
    const fs::path file = find_scene_file(path);
    return parse_scene(read_text_file(file), file, settings);
}

}  // namespace palpa
