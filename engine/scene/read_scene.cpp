#include "scene/read_scene.h"

#include "core/file_versions.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "scene/check_scene.h"
#include "scene/edit_fields.h"
#include "scene/fields.h"
#include "scene/find_scene.h"
#include "scene/hand_tables.h"
#include "scene/problems.h"
#include "scene/run_commands.h"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// ---- where a node stands ---------------------------------------------------------------------

// What stands before a setting in place of a file: of the command line, of an edit.
constexpr std::array<std::string_view, 2> setting_origins{"--set ", "setting "};

TextPlace place_of(const toml::source_region& source) {
    TextPlace place{source.path ? *source.path : "", source.begin.line, source.begin.column};
    const bool is_setting = std::ranges::any_of(
        setting_origins, [&](std::string_view origin) { return place.file.starts_with(origin); });
    if (is_setting) place.line = place.column = 0;  // it is one line
    return place;
}

// What a message quotes of a word that may be as long as the file.
std::string quote_word(std::string_view text) {
    constexpr std::size_t most = 80;
    return fmt::format("\"{}\"{}", text.substr(0, most), text.size() > most ? "..." : "");
}

// What a node holds, as a person would call it.
std::string setting_of(const toml::node& node);

std::string kind_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array: {
            const toml::array& list = *node.as_array();
            const bool is_short =
                list.size() <= 4 &&
                std::ranges::all_of(list, [](const auto& each) { return each.is_number(); });
            return is_short && !list.empty() ? "the list " + setting_of(node) : "a list";
        }
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

// The value of a setting, as a person types it.
std::string setting_of(const toml::node& node) {
    if (const toml::array* const list = node.as_array()) {
        std::vector<std::string> entries;
        for (const toml::node& entry : *list) entries.push_back(setting_of(entry));
        return fmt::format("[{}]", fmt::join(entries, ", "));
    }
    return node.is_string() ? node.ref<std::string>() : kind_of(node);
}

// ---- what a text has to name -------------------------------------------------------------------

bool has_form(std::string_view text, TextForm form) {
    if (form == TextForm::Any) return true;
    const std::optional<Address> address = find_address(text);
    if (!address) return false;
    if (form == TextForm::Molecule) return address->residue.empty();
    if (form == TextForm::ResidueOrAtom) return !address->residue.empty();
    return form == TextForm::MoleculeOrPart || !address->atom.empty();
}

std::string_view form_meaning(TextForm form) {
    switch (form) {
        case TextForm::Molecule:
            return "the name of a molecule";
        case TextForm::MoleculeOrPart:
            return "a molecule, residue or atom, \"NAME\", \"NAME:25\" or \"NAME:25 CA\"";
        case TextForm::ResidueOrAtom:
            return "a residue or atom, \"NAME:25\" or \"NAME:25 CA\"";
        case TextForm::Atom:
            return "an atom, \"NAME:25 CA\"";
        case TextForm::Any:
            break;
    }
    return "text";
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

// What a file may have.
struct ReadingRules {
    bool allows_outside = false;      // files from anywhere
    bool leaves_out_unknown = false;  // of a newer minor format
};

ReadingRules rules_of(FileVersion version) { return {false, version > scene_version}; }

// Fills a description from a table.
class Reader final : public FieldVisitor {
public:
    Reader(const toml::table& root, const fs::path& file, const ReadingRules& rules,
           Problems& problems)
        : Reader(root, file, file.parent_path(), rules, problems) {}
    // `folder`: from where file names are taken.
    Reader(const toml::table& root, fs::path file, fs::path folder, const ReadingRules& rules,
           Problems& problems)
        : file_(std::move(file)),
          folder_(std::move(folder)),
          rules_(rules),
          problems_(problems),
          is_made_(!root["made_by"].value_or(std::string()).empty()) {
        if (!rules.allows_outside) {
            may_read_ = {real_path(folder_.empty() ? "." : folder_)};
            for (const fs::path& own : own_scene_folders()) {
                may_read_.push_back(real_path(own));
            }
        }
        levels_.push_back({&root, "", place_or_start(root), {}, false});
    }

    // Notes keys that are unknown. `problems` holds what was found wrong.
    void finish() { report_unknown_keys(levels_.back()); }

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
            problem(levels_.back().place, fmt::format("the table [{}] is missing: {}",
                                                      full_key(field.key), field.meaning));
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
                    fmt::format("[{}] has no table; expected {}",
                                level.path.substr(0, level.path.size() - 1), field.meaning));
        }
    }

    void list_entries(const Field& field, std::size_t& count) override {
        count = 0;
        const toml::node* const node = find(field);
        if (!node) return;
        const toml::array* const list = node->as_array();
        const auto size = static_cast<double>(list ? list->size() : 0);
        if (list && field.highest > 0 && (size < field.lowest || size > field.highest)) {
            problem(*node, fmt::format("'{0}' has {1} entries; expected {2} to {3} tables [[{0}]]",
                                       full_key(field.key), size, field.lowest, field.highest));
        } else if (list) {
            count = list->size();
        } else {
            problem(*node, fmt::format("'{0}' is {1}; expected a list of tables, [[{0}]]",
                                       full_key(field.key), kind_of(*node)));
        }
    }

    void enter_entry(const Field& field, std::size_t index, TextPlace& place) override {
        const std::string key = fmt::format("{}[{}]", full_key(field.key), index + 1);
        const toml::node& node = *levels_.back().table->get(field.key)->as_array()->get(index);
        place = place_of(node.source());
        if (place.file.empty()) place = levels_.back().place;  // a table that no text has
        problems_.set_place(key, place);
        const toml::table* const table = node.as_table();
        if (!table) problem(node, fmt::format("'{}' is {}; expected a table", key, kind_of(node)));
        levels_.push_back({table, key + ".", place, {}, table == nullptr});
    }

    std::vector<std::size_t> one_of(std::span<const std::string_view> keys,
                                    std::size_t /*chosen*/) override {
        Level& level = levels_.back();
        level.known.insert(level.known.end(), keys.begin(), keys.end());
        if (!level.table) return {};
        std::vector<std::pair<toml::source_position, std::size_t>> found;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            const auto place = level.table->find(keys[i]);
            if (place != level.table->end()) {
                found.emplace_back(place->first.source().begin, i);
            }
        }
        if (found.empty()) {
            const std::string whole =
                level.path.substr(0, std::max<std::size_t>(level.path.size(), 1) - 1);
            level.lacks = fmt::format("{} has none of the keys {}; expected one of them",
                                      whole.empty() ? "the line" : fmt::format("'{}'", whole),
                                      fmt::join(keys, ", "));
            return {};
        }
        std::ranges::sort(found);
        for (std::size_t i = 1; i < found.size(); ++i) {
            const std::string_view extra = keys[found[i].second];
            problem(place_of(level.table->find(extra)->first.source()),
                    fmt::format("'{}' and '{}' are both given; expected one of them",
                                full_key(extra), keys[found[0].second]));
        }
        return {found[0].second};
    }

    bool is_there(const Field& field, bool /*there*/) override { return find(field) != nullptr; }
    bool is_list(const Field& field, bool /*list*/) override {
        const toml::node* const node = find(field);
        return node && node->is_array();
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
        if (field.required && !field.may_be_empty && node->ref<std::string>().empty()) {
            return problem(*node, expected(field, *node, "text that is not empty"));
        }
        if (!has_form(node->ref<std::string>(), field.form)) {
            return problem(*node, expected(field, *node, form_meaning(field.form)));
        }
        value = node->ref<std::string>();
    }

    void texts(const Field& field, std::vector<std::string>& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        const toml::array* const list = node->as_array();
        if (!list) return problem(*node, expected(field, *node, "a list of texts, [\"...\"]"));
        const auto count = static_cast<double>(list->size());
        if (field.highest > 0 && (count < field.lowest || count > field.highest)) {
            return problem(*node,
                           fmt::format("'{}' is a list of {}; expected {} to {} texts",
                                       full_key(field.key), count, field.lowest, field.highest));
        }
        value.clear();
        for (const toml::node& entry : *list) {
            if (!entry.is_string()) {
                return problem(entry, fmt::format("an entry of '{}' is {}; expected text in quotes",
                                                  full_key(field.key), kind_of(entry)));
            }
            if (!has_form(entry.ref<std::string>(), field.form)) {
                return problem(
                    entry, fmt::format("an entry of '{}' is {}; expected {}", full_key(field.key),
                                       kind_of(entry), form_meaning(field.form)));
            }
            value.push_back(entry.ref<std::string>());
        }
    }

    void choice(const Field& field, std::span<const std::string_view> names,
                std::size_t& value) override {
        const toml::node* const node = find_value(field);
        if (!node) return;
        std::string read = node->is_string()    ? node->ref<std::string>()
                           : node->is_integer() ? fmt::format("{}", node->ref<std::int64_t>())
                                                : "";
        const auto found = std::find(names.begin(), names.end(), read);
        if (found == names.end() && rules_.leaves_out_unknown) {
            return problems_.add_note(place_of(node->source()),
                                      fmt::format("'{}' is {}, which this program does not know: "
                                                  "left out",
                                                  full_key(field.key), kind_of(*node)));
        }
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
                    entry,
                    fmt::format(
                        "an entry of '{}' is not a point of a path; expected [s, mm], [s, mm, mm, "
                        "mm] or [s, mm, mm, mm, degrees, degrees, degrees], numbers from {} to {}",
                        full_key(field.key), field.lowest, field.highest));
            }
            value.push_back(*point);
        }
    }

    void mark(const Field& field) override {
        const toml::node* const node = find_value(field);
        if (node && node->value_exact<bool>() != true) {
            problem(*node, expected(field, *node, "true, or no such key"));
        }
    }

    void coupling_settings(const Field& field, std::vector<std::string>& value) override {
        enter_table(field);
        CouplingDescription read;  // for what is wrong with the values
        visit_coupling_keys(*this, read);
        value.clear();
        const Level& level = levels_.back();
        for (const std::string& key : level.known) {
            if (const toml::node* const node = level.table ? level.table->get(key) : nullptr) {
                value.push_back(fmt::format("{}={}", key, setting_of(*node)));
            }
        }
        if (level.table && level.table->empty()) {
            problem(level.place, fmt::format("'{}' is empty; expected one of {}",
                                             level.path.substr(0, level.path.size() - 1),
                                             fmt::join(level.known, ", ")));
        }
        leave_table();
    }

private:
    // One table under way. `table` is null where the file has none: defaults, or errors.
    struct Level {
        const toml::table* table;
        std::string path;  // "molecules.fixed."
        TextPlace place;
        std::vector<std::string> known;  // keys that were asked for
        bool missing;                    // reported already
        std::string lacks = {};  // message, unless a key is unknown, which was meant for what lacks
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
        if (std::ranges::find(level.known, field.key) == level.known.end()) {
            level.known.emplace_back(field.key);
        }
        const toml::node* const node = level.table ? level.table->get(field.key) : nullptr;
        if (node) problems_.set_place(full_key(field.key), place_of(node->source()));
        return node;
    }

    // The node of a field that is no table; names a required one that is not there.
    const toml::node* find_value(const Field& field) {
        const toml::node* const node = find(field);
        const Level& level = levels_.back();
        if (!node && field.required && !level.missing) {
            problem(level.place,
                    fmt::format("the key '{}' is missing: {}", full_key(field.key), field.meaning));
        }
        return node;
    }

    std::string expected(const Field& field, const toml::node& node, std::string_view right) const {
        return fmt::format("'{}' is {}; expected {}", full_key(field.key), kind_of(node), right);
    }

    static std::string range(const Field& field, std::string_view kind) {
        return fmt::format("{} {}from {} to {}", kind, field.zero ? "that is 0 or " : "",
                           field.lowest, field.highest);
    }

    bool read_file_name(const Field& field, const toml::node& node, fs::path& value) {
        if (!node.is_string() || node.ref<std::string>().empty() ||
            node.ref<std::string>().find('\0') != std::string::npos) {
            problem(node, expected(field, node, "a file name in quotes"));
            return false;
        }
        value = folder_ / node.ref<std::string>();
        const fs::path real = real_path(value);
        if (!may_read_.empty() && std::ranges::none_of(may_read_, [&](const fs::path& folder) {
                return is_below(real, folder);
            })) {
            problem(node,
                    fmt::format("'{}' names {}, which is outside of the scene's folder; expected a "
                                "file in this folder, or --allow-outside if you trust the scene",
                                full_key(field.key), quote_word(node.ref<std::string>())));
            return false;
        }
        std::error_code error;
        const fs::file_type type = fs::status(value, error).type();
        if (type == fs::file_type::regular) return true;
        if (!missing_.insert(value).second) return false;  // was named already
        if (type != fs::file_type::not_found) {
            problem(node, fmt::format("'{}' names {}: {}; expected a file in the scene's folder",
                                      full_key(field.key), value.generic_string(),
                                      error ? error.message() : "this is not a regular file"));
            return false;
        }
        problem(node, fmt::format("'{}' names a file that does not exist: {}; expected a file in "
                                  "the scene's folder{}",
                                  full_key(field.key), value.generic_string(),
                                  is_made_ ? " (its key made_by says how to make the file)" : ""));
        return false;
    }

    static std::vector<toml::key> find_unknown_keys(const Level& level) {
        std::vector<toml::key> unknown;
        if (!level.table) return unknown;
        for (const auto& [key, node] : *level.table) {
            const bool is_known = std::ranges::find(level.known, key.str()) != level.known.end();
            if (!is_known) unknown.push_back(key);
        }
        return unknown;
    }

    void report_unknown_keys(const Level& level) {
        const std::vector<std::string_view> known(level.known.begin(), level.known.end());
        const std::vector<toml::key> unknown = find_unknown_keys(level);
        // Otherwise the unknown key is the likely cause, and its own message says what is expected.
        if (!level.lacks.empty() && (unknown.empty() || rules_.leaves_out_unknown))
            problem(level.place, level.lacks);
        for (const toml::key& key : unknown) {
            const TextPlace place = place_of(key.source());
            const std::string name = level.path + std::string(key.str());
            if (rules_.leaves_out_unknown) {
                problems_.add_note(
                    place, fmt::format("this program does not know the key '{}': left out", name));
                continue;
            }
            const std::string hint = near_name_hint(key.str(), known);
            problem(place, fmt::format("unknown key '{}'{}", name,
                                       hint.empty() ? fmt::format("; expected one of {}",
                                                                  fmt::join(known, ", "))
                                                    : hint));
        }
    }

    void problem(const TextPlace& place, std::string what) {
        problems_.add(place, std::move(what));
    }
    void problem(const toml::node& node, std::string what) {
        problem(place_of(node.source()), std::move(what));
    }

    fs::path file_, folder_;
    ReadingRules rules_;
    Problems& problems_;
    std::vector<fs::path> may_read_;  // folders, links resolved; empty: everything
    std::set<fs::path> missing_;      // files that are named and do not exist
    bool is_made_;                    // the scene says how its files are made
    std::vector<Level> levels_;
};

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
    if (key == "edits" || key.starts_with("edits.") || key.starts_with("edits[")) {
        throw LoadError(place,
                        "edits cannot be set here; write them as [[edits]] into the scene file");
    }
    if (key.find('.') != std::string::npos) return key;
    std::vector<std::string> matches;
    std::vector<std::string_view> last_parts;
    std::vector<FieldNote> fields = list_fields();
    std::erase_if(fields, [](const FieldNote& field) {
        // A bare name is one of the first hand.
        return field.key.starts_with("edits.") || field.key.starts_with("hand[");
    });
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
        throw LoadError(place, fmt::format("there is no scene key '{}'{}", key,
                                           near_name_hint(key, last_parts)));
    }
    throw LoadError(place, fmt::format("'{}' can mean {}; expected the full key", key,
                                       fmt::join(matches, " or ")));
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
        throw LoadError(place,
                        "the value is not valid TOML; expected a number, true, false, a word or "
                        "text in quotes");
    }
    return "\"" + value + "\"";
}

void apply_setting(std::string_view origin, const std::string& setting, toml::table& root) {
    const bool printable = std::none_of(setting.begin(), setting.end(), [](char letter) {
        return static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f;
    });
    if (!printable) {
        throw LoadError(
            {std::string(trimmed(origin))},
            "a setting has characters that cannot be printed; expected one line of text");
    }
    const TextPlace place{std::string(origin) + setting};
    check_dots(setting, place);
    const std::size_t equals = setting.find('=');
    const std::string left(trimmed(std::string_view(setting).substr(0, equals)));
    if (equals == std::string::npos || left.empty()) {
        throw LoadError(place, "expected KEY=VALUE, such as coupling.mode=2");
    }
    const std::string key = full_setting_key(left, place);
    if (key.starts_with('.') || key.ends_with('.') || key.find("..") != std::string::npos) {
        throw LoadError(place, fmt::format("'{}' is not a key", key));
    }
    const std::string value =
        setting_value(trimmed(std::string_view(setting).substr(equals + 1)), place);
    try {
        const auto [table, inner] = find_table_of(key, place, root);
        merge(toml::parse(std::string_view(inner + " = " + value), std::string_view(place.file)),
              *table);
    } catch (const toml::parse_error&) {
        throw LoadError(place, fmt::format("'{}' is not a key", key));
    }
}

}  // namespace

namespace {

toml::table parse_table(std::string_view text, const fs::path& file) {
    std::size_t line_number = 0;
    for (const std::string_view line : split_lines(text)) {
        check_dots(line, {file.string(), ++line_number, 1});
    }
    try {
        return toml::parse(text, std::string_view(file.string()));
    } catch (const toml::parse_error& error) {
        std::string what(error.description());
        if (!what.empty() && what[0] >= 'A' && what[0] <= 'Z') what[0] += 'a' - 'A';
        throw LoadError(place_of(error.source()), what);
    }
}

// Reads the version that the key `format` states. Throws LoadError for a version that cannot be
// read; one of a newer minor number is a note.
FileVersion read_version(const toml::table& root, Problems& problems) {
    const toml::node* const node = root.get("format");
    if (!node || !node->is_string()) return scene_version;
    const TextPlace place = place_of(node->source());
    const std::optional<FileVersion> version = find_version(node->ref<std::string>());
    if (!version) {
        throw LoadError(place, fmt::format("'format' is {}; expected a version, \"{}\"",
                                           kind_of(*node), to_string(scene_version)));
    }
    if (const auto note = check_version("scene", *version, scene_version, place))
        problems.add_note(place, *note);
    return *version;
}

}  // namespace

SceneDescription parse_scene(std::string_view text, const fs::path& file,
                             std::span<const std::string> settings) {
    toml::table root = parse_table(text, file);
    if (root.empty()) {
        throw LoadError({file.string(), 1, 1},
                        "an empty scene; expected [force_field], [molecules.NAME] and [grab]");
    }
    gather_hands(root);
    const bool allows_outside = std::ranges::find(settings, allow_outside) != settings.end();
    // Settings that add hands first: with one hand, "hand[1].coupling" means [coupling].
    for (const bool adds_hands : {true, false})
        for (const std::string& setting : settings)
            if (setting != allow_outside && names_further_hand(setting) == adds_hands)
                apply_setting(setting_origins[0], setting, root);

    SceneDescription scene;
    scene.file = file;
    Problems problems(file);
    ReadingRules rules = rules_of(read_version(root, problems));
    rules.allows_outside = allows_outside;
    Reader reader(root, file, rules, problems);
    visit_scene(reader, scene);
    check_scene(scene, problems);
    reader.finish();
    scene.places = problems.finish();
    scene.notes = problems.take_notes();
    return scene;
}

namespace {

// `check` sees it before what does not fit is thrown.
template <class Check>
CouplingDescription read_coupling(const CouplingDescription& coupling,
                                  std::span<const std::string> settings, const Check& check) {
    constexpr std::string_view table = "coupling.";
    toml::table root;
    for (const std::string& setting : settings) {
        const bool is_full = trimmed(setting).starts_with(table);
        apply_setting(setting_origins[1], is_full ? setting : std::string(table) + setting, root);
    }
    CouplingDescription result = coupling;
    Problems problems({});
    Reader reader(root, {}, {.allows_outside = true}, problems);
    reader.enter_table({.key = "coupling", .meaning = "from molecule to hand and back"});
    visit_coupling_keys(reader, result);
    reader.leave_table();
    check(result, problems);
    reader.finish();
    (void)problems.finish();
    return result;
}

}  // namespace

CouplingDescription with_settings(const CouplingDescription& coupling,
                                  std::span<const std::string> settings) {
    if (settings.empty()) return coupling;
    return read_coupling(coupling, settings, [](const auto& read, Problems& problems) {
        check_coupling("coupling", read, problems);
    });
}

CouplingDescription parse_settings(std::span<const std::string> settings) {
    return read_coupling({}, settings, [](const auto&, const auto&) {});
}

EditDescription parse_edit(std::string_view text, const TextPlace& place) {
    SceneDescription scene;
    scene.hands.resize(most_hands);
    try {
        const fs::path name = "edit";  // its lines count from its own start
        const toml::table root = parse_table(text, name);
        Problems problems({});
        Reader reader(root, name, fs::path(place.file).parent_path(), {}, problems);
        visit_edits(reader, scene.edits);
        check_edits(scene, problems);
        reader.finish();
        (void)problems.finish();
    } catch (const LoadError& error) {
        throw LoadError(place, error.what());
    }
    if (scene.edits.size() != 1) {
        throw LoadError(
            place, fmt::format("has {} edits; expected one table [[edits]]", scene.edits.size()));
    }
    scene.edits.front().place = place;
    return scene.edits.front();
}

namespace {

// Up to a # outside of quotes.
std::string_view without_comment(std::string_view line) {
    char quote = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (quote == '"' && line[i] == '\\') {
            ++i;
        } else if (quote != 0) {
            if (line[i] == quote) quote = 0;
        } else if (line[i] == '"' || line[i] == '\'') {
            quote = line[i];
        } else if (line[i] == '#') {
            return line.substr(0, i);
        }
    }
    return line;
}

// The line with the sign = that a word may be without.
std::string with_equals(std::string_view line) {
    const std::size_t end = std::min(line.find_first_of(" \t="), line.size());
    const std::string_view word = line.substr(0, end), rest = trimmed(line.substr(end));
    if (rest.starts_with('=')) return std::string(line);
    if (rest.empty()) {
        const char* const value = word == "read" ? "\"\"" : word == "step" ? "1" : "true";
        return fmt::format("{} = {}", word, value);
    }
    return fmt::format("{} = {}", word, rest);
}

RunCommand read_run_command(std::string_view line, const SceneDescription& scene) {
    toml::table root = parse_table(fmt::format("line = {{{}}}", with_equals(line)), {});
    const toml::table* const table = root.size() == 1 ? root["line"].as_table() : nullptr;
    if (!table) throw LoadError({}, "is not a list of KEY = VALUE separated by commas");
    RunCommand command;
    Problems problems({});
    Reader reader(*table, {}, scene.file.parent_path(), {}, problems);
    visit_run_command(reader, command);
    const auto* const edit = std::get_if<EditAction>(&command.action);
    if (!problems.any())
        check_edit({0, command.hand, edit ? *edit : EditAction(), {}}, scene.hands.size(), "",
                   problems);
    reader.finish();
    (void)problems.finish();
    return command;
}

}  // namespace

std::optional<RunCommand> parse_run_command(std::string_view line, const SceneDescription& scene,
                                            const TextPlace& place) {
    if (line.size() > most_command_bytes) {
        throw LoadError(place, fmt::format("the line has {} bytes; expected at most {}",
                                           line.size(), most_command_bytes));
    }
    line = trimmed(without_comment(line));
    if (line.empty()) return std::nullopt;
    if (line.find('\n') != std::string_view::npos) throw LoadError(place, "is more than one line");
    try {
        return read_run_command(line, scene);
    } catch (const LoadError& error) {
        // Its place is within the braces around the line, which nobody wrote.
        const std::string_view what = error.what();
        throw LoadError(place, std::string(what.substr(what.find(": ") + 2)));
    }
}

SceneDescription read_scene(const fs::path& path, std::span<const std::string> settings) {
    const fs::path file = find_scene_file(path);
    return parse_scene(read_text_file(file), file, settings);
}

}  // namespace palpa
