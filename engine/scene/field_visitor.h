// A visitor of the fields of a scene file: key, meaning, range, and the value itself.
#pragma once
#include "core/load_error.h"

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

struct PathPoint;

inline constexpr double farthest_angstrom = 1e4;  // of a place from the origin

// The form of a text that names a part of the scene (scene/edits.h).
enum class TextForm { Any, Molecule, MoleculeOrPart, ResidueOrAtom, Atom };

struct Field {
    std::string_view key;
    std::string_view meaning;
    double lowest = 0, highest = 0;  // range of a number; a test checks that every number has one
    bool zero = false;               // 0 is allowed, below `lowest`
    bool required = false;
    bool may_be_empty = false;  // a required text
    bool may_be_unset = false;  // three numbers
    TextForm form = TextForm::Any;
    bool is_inline = false;  // a table in braces
};

class FieldVisitor {
public:
    FieldVisitor() = default;
    FieldVisitor(const FieldVisitor&) = delete;
    FieldVisitor& operator=(const FieldVisitor&) = delete;
    virtual ~FieldVisitor() = default;

    virtual void enter_table(const Field& field) = 0;
    virtual void leave_table() = 0;
    // The tables inside the present one by name: a reader fills `names`, other visitors follow
    // them.
    virtual void list_tables(const Field& field, std::vector<std::string>& names) = 0;

    // Entries of a list of tables: a reader fills `count` and `place`, other visitors follow them.
    virtual void list_entries(const Field& field, std::size_t& count) = 0;
    virtual void enter_entry(const Field& field, std::size_t index, TextPlace& place) = 0;

    // The keys to visit: the one in the file, or `chosen` if none is read.
    virtual std::vector<std::size_t> one_of(std::span<const std::string_view> keys,
                                            std::size_t chosen) = 0;
    // Whether to visit an optional part; a reader looks into the file.
    virtual bool is_there(const Field& field, bool there) = 0;
    // Whether a table is given as a list of such tables; a reader looks into the file.
    virtual bool is_list(const Field& field, bool list) = 0;
    // Whether keys are being listed for documentation: then every table exists.
    virtual bool is_listing() const noexcept { return false; }

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
    // A key that can only be true.
    virtual void mark(const Field& field) = 0;
    // A table with some keys of [coupling], as settings "key=value".
    virtual void coupling_settings(const Field& field, std::vector<std::string>& value) = 0;
};

// A choice among enumerators, by names in their order.
template <class Enum, std::size_t Count>
void choose(FieldVisitor& visitor, const Field& field,
            const std::array<std::string_view, Count>& names, Enum& value) {
    auto index = static_cast<std::size_t>(value);
    visitor.choice(field, names, index);
    value = static_cast<Enum>(index);
}
template <class Enum, std::size_t Count>
void choose_if_set(FieldVisitor& visitor, const Field& field,
                   const std::array<std::string_view, Count>& names, std::optional<Enum>& value) {
    std::optional<std::size_t> index;
    if (value) index = static_cast<std::size_t>(*value);
    visitor.optional_choice(field, names, index);
    if (index) value = static_cast<Enum>(*index);
}

void triple_if_set(FieldVisitor& visitor, Field field, std::optional<std::array<double, 3>>& value);

// A list of tables: `visit_entry(entry)` visits the fields of one, which has a `place`.
template <class Entry, class VisitEntry>
void visit_entries(FieldVisitor& visitor, const Field& field, std::vector<Entry>& entries,
                   const VisitEntry& visit_entry) {
    std::size_t count = entries.size();
    visitor.list_entries(field, count);
    entries.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        visitor.enter_entry(field, i, entries[i].place);
        visit_entry(entries[i]);
        visitor.leave_table();
    }
}

}  // namespace palpa
