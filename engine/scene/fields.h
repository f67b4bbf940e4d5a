// All fields of a scene file, each with its key, meaning and range, in one list. Reading, writing
// and documenting a scene are three visitors of that list.
#pragma once
#include "scene/description.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

struct Field {
    std::string_view key;
    std::string_view meaning;
    double lowest = 0, highest = 0;  // of a number; every one has a range, which a test looks at
    bool zero = false;               // 0 will do, below `lowest`
    bool required = false;
};

class FieldVisitor {
public:
    FieldVisitor() = default;
    FieldVisitor(const FieldVisitor&) = delete;
    FieldVisitor& operator=(const FieldVisitor&) = delete;
    virtual ~FieldVisitor() = default;

    virtual void enter_table(const Field& field) = 0;
    virtual void leave_table() = 0;
    // The tables inside the present one, by name; a reader fills `names`, others go by them.
    virtual void list_tables(const Field& field, std::vector<std::string>& names) = 0;

    virtual void real(const Field& field, double& value) = 0;
    virtual void optional_real(const Field& field, std::optional<double>& value) = 0;
    virtual void optional_pair(const Field& field, std::optional<std::array<double, 2>>& value) = 0;
    virtual void triple(const Field& field, std::array<double, 3>& value) = 0;
    virtual void flag(const Field& field, bool& value) = 0;
    virtual void integer(const Field& field, std::int64_t& value) = 0;
    virtual void text(const Field& field, std::string& value) = 0;
    virtual void texts(const Field& field, std::vector<std::string>& value) = 0;
    virtual void choice(const Field& field, std::span<const std::string_view> names,
                        std::size_t& value) = 0;
    virtual void optional_choice(const Field& field, std::span<const std::string_view> names,
                                 std::optional<std::size_t>& value) = 0;
    virtual void file(const Field& field, std::filesystem::path& value) = 0;
    virtual void files(const Field& field, std::vector<std::filesystem::path>& value) = 0;
    virtual void path(const Field& field, std::vector<PathPoint>& value) = 0;
};

void visit_scene(FieldVisitor& visitor, SceneDescription& scene);

// For documentation and messages: every key in full ("molecules.NAME.segment") with its meaning,
// default or choices, and range.
struct FieldNote {
    std::string key, type, fallback, meaning;
};
std::vector<FieldNote> list_fields();

}  // namespace palpa
