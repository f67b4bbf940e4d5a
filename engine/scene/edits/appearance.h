#pragma once
#include "core/translate.h"
#include "scene/choices.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"
#include "scene/problems.h"

#include <fmt/format.h>
#include <cstddef>
#include <optional>
#include <string>

namespace palpa {

class World;

// How a molecule is drawn. Unset fields stay unchanged.
struct AppearanceEdit {
    static constexpr EditKind kind{.key = "appearance", .with_engine = true, .is_quick = true};

    std::string molecule;
    std::optional<Representation> representation;
    std::optional<Colouring> colouring;
    std::optional<bool> visible;

    void visit(FieldVisitor& v) {
        v.enter_table({.key = kind.key, .meaning = "as in [view]", .is_inline = true});
        v.text({.key = "molecule",
                .meaning = "name of a molecule",
                .required = true,
                .form = TextForm::Molecule},
               molecule);
        choose_if_set(v, {.key = "representation", .meaning = "as in [view]"}, representation_names,
                      representation);
        choose_if_set(v, {.key = "colour", .meaning = "as in [view]"}, colouring_names, colouring);
        const Field is_drawn{.key = "visible", .meaning = "whether it is drawn"};
        if (v.is_there(is_drawn, visible.has_value())) {
            if (!visible) visible.emplace();
            v.flag(is_drawn, *visible);
        }
        v.leave_table();
    }
    void check(const std::string& key, Problems& problems) const {
        if (representation || colouring || visible) return;
        problems.add(
            problems.place_of(key),
            fmt::format("'{}' changes nothing; expected representation, colour or visible", key));
    }
    std::string undo_name() const { return format_translated("appearance of {}", molecule); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const AppearanceEdit&, const AppearanceEdit&) = default;
};

}  // namespace palpa
