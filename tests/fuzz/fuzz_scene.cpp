// Any text with any settings is a scene or a LoadError; a scene reads the same once written.
// Settings are the lines of the text that begin with "#set ", a comment to TOML.
#include "core/load_error.h"
#include "core/text.h"
#include "scene/fields.h"
#include "scene/read_scene.h"
#include "scene/write_scene.h"
#include "tests/fuzz/expect.h"
#include "tests/support/paths.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;

namespace {

std::optional<SceneDescription> read_or_refuse(std::string_view text,
                                               std::span<const std::string> settings) {
    try {
        return parse_scene(text, test::in_project("scenes/water/fuzz.toml"), settings);
    } catch (const LoadError&) {
        return std::nullopt;
    }
}

std::string formatted(const SceneDescription& scene) {
    return format_scene(scene, [](const std::filesystem::path& file) { return file.string(); });
}

// What the reader promises of single fields, asked by a visitor of its own.
class RangeCheck final : public FieldVisitor {
public:
    void enter_table(const Field& /*field*/) override {}
    void leave_table() override {}
    void list_tables(const Field& /*field*/, std::vector<std::string>& /*names*/) override {}
    void list_entries(const Field& /*field*/, std::size_t& /*count*/) override {}
    void enter_entry(const Field& /*field*/, std::size_t /*index*/, TextPlace& place) override {
        PALPA_EXPECT(!place.file.empty());
    }
    std::vector<std::size_t> one_of(std::span<const std::string_view> keys,
                                    std::size_t chosen) override {
        PALPA_EXPECT(chosen < keys.size());
        return {chosen};
    }
    bool is_there(const Field& /*field*/, bool there) override { return there; }
    bool is_list(const Field& /*field*/, bool list) override { return list; }
    void real(const Field& field, double& value) override {
        PALPA_EXPECT(std::isfinite(value) && value >= field.lowest && value <= field.highest);
    }
    void optional_real(const Field& field, std::optional<double>& value) override {
        if (value) real(field, *value);
    }
    void optional_pair(const Field& field, std::optional<std::array<double, 2>>& value) override {
        if (!value) return;
        for (double& number : *value) real(field, number);
    }
    void triple(const Field& field, std::array<double, 3>& value) override {
        for (double& number : value) real(field, number);
    }
    void flag(const Field& /*field*/, bool& /*value*/) override {}
    void texts(const Field& field, std::vector<std::string>& value) override {
        PALPA_EXPECT(field.highest == 0 || (static_cast<double>(value.size()) >= field.lowest &&
                                            static_cast<double>(value.size()) <= field.highest));
    }
    void integer(const Field& field, std::int64_t& value) override {
        auto real_value = static_cast<double>(value);
        real(field, real_value);
    }
    void text(const Field& field, std::string& value) override {
        PALPA_EXPECT(!field.required || !value.empty());
    }
    void choice(const Field& /*field*/, std::span<const std::string_view> names,
                std::size_t& value) override {
        PALPA_EXPECT(value < names.size());
    }
    void optional_choice(const Field& field, std::span<const std::string_view> names,
                         std::optional<std::size_t>& value) override {
        if (value) choice(field, names, *value);
    }
    void file(const Field& field, std::filesystem::path& value) override {
        PALPA_EXPECT(!field.required || !value.empty());
    }
    void files(const Field& /*field*/, std::vector<std::filesystem::path>& value) override {
        PALPA_EXPECT(!value.empty());
    }
    void path(const Field& /*field*/, std::vector<PathPoint>& value) override {
        for (const auto& [time_s, place, turn] : value) {
            PALPA_EXPECT(std::isfinite(time_s));
            for (const double number : place) PALPA_EXPECT(std::isfinite(number));
            for (const double number : turn) PALPA_EXPECT(std::isfinite(number));
        }
    }
    void mark(const Field& /*field*/) override {}
    void coupling_settings(const Field& /*field*/, std::vector<std::string>& value) override {
        PALPA_EXPECT(!value.empty());
    }
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    std::vector<std::string> settings;
    for (const std::string_view line : split_lines(text)) {
        if (line.starts_with("#set ")) settings.emplace_back(line.substr(5));
    }
    std::optional<SceneDescription> scene = read_or_refuse(text, settings);
    if (!scene) return 0;

    RangeCheck check;
    visit_scene(check, *scene);
    const std::string written = formatted(*scene);
    const std::optional<SceneDescription> back = read_or_refuse(written, {});
    PALPA_EXPECT(back);
    PALPA_EXPECT(formatted(*back) == written);
    return 0;
}
