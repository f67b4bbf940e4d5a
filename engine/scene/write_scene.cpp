#include "scene/write_scene.h"

#include "core/file_versions.h"
#include "core/text.h"
#include "scene/edit_fields.h"
#include "scene/fields.h"

#include <fmt/format.h>
#include <cstdint>
#include <optional>
#include <utility>

namespace palpa {
namespace {

// A key needs no quotes if it is made of letters, digits, '_' and '-'.
std::string key_text(std::string_view key) {
    const bool bare = !key.empty() && key.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyz"
                                          "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_-") == std::string::npos;
    return bare ? std::string(key) : in_quotes(key);
}

// The value of a setting as TOML: a number or list as it is, a bare word in quotes.
std::string setting_text(std::string_view value) {
    const bool is_toml = value.starts_with('[') || value.starts_with('"');
    if (is_toml) return std::string(value);
    if (const std::optional<std::int64_t> number = find_integer(value)) {
        return fmt::format("{}", *number);
    }
    if (const std::optional<double> number = find_real(value)) return format_real(*number);
    return in_quotes(value);
}

class Writer final : public FieldVisitor {
public:
    explicit Writer(const std::function<std::string(const std::filesystem::path&)>& file_name)
        : file_name_(file_name) {}

    std::string text_so_far;

    void enter_table(const Field& field) override {
        if (field.is_inline) {
            inline_table_ = field;
            inline_pairs_.clear();
            return;
        }
        path_.push_back(key_text(field.key));
        header_due_ = true;
    }
    void leave_table() override {
        if (inline_table_) {
            const Field table = *inline_table_;
            inline_table_.reset();
            return add(table, fmt::format("{{ {} }}", fmt::join(inline_pairs_, ", ")));
        }
        path_.pop_back();
        header_due_ = !path_.empty();
    }
    void list_tables(const Field& /*field*/, std::vector<std::string>& /*names*/) override {}
    void list_entries(const Field& /*field*/, std::size_t& /*count*/) override {}
    void enter_entry(const Field& field, std::size_t /*index*/, TextPlace& /*place*/) override {
        path_.push_back(key_text(field.key));
        text_so_far += fmt::format("\n[[{}]]\n", fmt::join(path_, "."));
        header_due_ = false;
    }
    std::vector<std::size_t> one_of(std::span<const std::string_view> /*keys*/,
                                    std::size_t chosen) override {
        return {chosen};
    }
    bool is_there(const Field& /*field*/, bool there) override { return there; }
    bool is_list(const Field& /*field*/, bool list) override { return list; }

    void real(const Field& field, double& value) override { add(field, format_real(value)); }
    void optional_real(const Field& field, std::optional<double>& value) override {
        if (value) add(field, format_real(*value));
    }
    void optional_pair(const Field& field, std::optional<std::array<double, 2>>& value) override {
        if (value) {
            const auto& [first, second] = *value;
            add(field, fmt::format("[{}, {}]", format_real(first), format_real(second)));
        }
    }
    void triple(const Field& field, std::array<double, 3>& value) override {
        add(field, fmt::format("[{}, {}, {}]", format_real(value[0]), format_real(value[1]),
                               format_real(value[2])));
    }
    void flag(const Field& field, bool& value) override { add(field, fmt::format("{}", value)); }
    void integer(const Field& field, std::int64_t& value) override {
        add(field, fmt::format("{}", value));
    }
    void text(const Field& field, std::string& value) override { add(field, in_quotes(value)); }
    void texts(const Field& field, std::vector<std::string>& value) override {
        std::vector<std::string> texts;
        for (const std::string& text : value) texts.push_back(in_quotes(text));
        add(field, fmt::format("[{}]", fmt::join(texts, ", ")));
    }
    void choice(const Field& field, std::span<const std::string_view> names,
                std::size_t& value) override {
        add(field, in_quotes(names[value]));
    }
    void optional_choice(const Field& field, std::span<const std::string_view> names,
                         std::optional<std::size_t>& value) override {
        if (value) add(field, in_quotes(names[*value]));
    }
    void file(const Field& field, std::filesystem::path& value) override {
        if (!value.empty()) add(field, in_quotes(file_name_(value)));
    }
    void files(const Field& field, std::vector<std::filesystem::path>& value) override {
        std::vector<std::string> names;
        for (const std::filesystem::path& path : value)
            names.push_back(in_quotes(file_name_(path)));
        add(field, fmt::format("[{}]", fmt::join(names, ", ")));
    }
    void path(const Field& field, std::vector<PathPoint>& value) override {
        std::vector<std::string> points;
        for (const auto& [time_s, place, turn] : value) {
            const bool turns = turn != std::array<double, 3>{};
            const bool in_space = turns || place[1] != 0 || place[2] != 0;
            std::vector<std::string> numbers{format_real(time_s), format_real(place[0])};
            if (in_space)
                numbers.insert(numbers.end(), {format_real(place[1]), format_real(place[2])});
            if (turns)
                for (const double angle : turn) numbers.push_back(format_real(angle));
            points.push_back(fmt::format("[{}]", fmt::join(numbers, ", ")));
        }
        add(field, fmt::format("[{}]", fmt::join(points, ", ")));
    }
    void mark(const Field& field) override { add(field, "true"); }
    void coupling_settings(const Field& field, std::vector<std::string>& value) override {
        std::vector<std::string> pairs;
        for (const std::string_view setting : value) {
            const std::size_t equals = setting.find('=');
            if (equals == std::string_view::npos) continue;  // says nothing
            pairs.push_back(fmt::format("{} = {}", key_text(trimmed(setting.substr(0, equals))),
                                        setting_text(trimmed(setting.substr(equals + 1)))));
        }
        add(field, fmt::format("{{ {} }}", fmt::join(pairs, ", ")));
    }

private:
    void add(const Field& field, const std::string& value) {
        if (inline_table_) {
            return inline_pairs_.push_back(fmt::format("{} = {}", field.key, value));
        }
        if (header_due_) text_so_far += fmt::format("\n[{}]\n", fmt::join(path_, "."));
        header_due_ = false;
        text_so_far += fmt::format("{} = {}\n", field.key, value);
    }

    const std::function<std::string(const std::filesystem::path&)>& file_name_;
    std::vector<std::string> path_;
    bool header_due_ = false;
    std::optional<Field> inline_table_;  // that is under way
    std::vector<std::string> inline_pairs_;
};

}  // namespace

std::string in_quotes(std::string_view text) {
    std::string result = "\"";
    for (const char letter : text) {
        if (letter == '"' || letter == '\\') {
            result += '\\';
            result += letter;
        } else if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) {
            result += fmt::format("\\u{:04X}", static_cast<unsigned>(letter));
        } else {
            result += letter;
        }
    }
    return result + "\"";
}

std::string format_edit(const EditDescription& edit) {
    const std::function<std::string(const std::filesystem::path&)> as_it_is =
        [](const std::filesystem::path& file) { return file.generic_string(); };
    Writer writer(as_it_is);
    std::vector<EditDescription> edits{edit};
    visit_edits(writer, edits);
    return std::move(writer.text_so_far);
}

std::vector<std::string> list_settings(const CouplingDescription& coupling) {
    const std::function<std::string(const std::filesystem::path&)> no_files;
    Writer writer(no_files);
    CouplingDescription copy = coupling;
    visit_coupling_keys(writer, copy);
    std::vector<std::string> settings;
    for (const std::string_view line : split_lines(writer.text_so_far)) settings.emplace_back(line);
    return settings;
}

std::string format_scene(
    const SceneDescription& scene,
    const std::function<std::string(const std::filesystem::path&)>& file_name) {
    Writer writer(file_name);
    SceneDescription copy = scene;  // visitors may write; this one does not
    copy.format = to_string(scene_version);
    visit_scene(writer, copy);
    return std::move(writer.text_so_far);
}

}  // namespace palpa
