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

// How a molecule may move. Unset fields stay unchanged.
struct MobilityEdit {
    static constexpr EditKind kind{.key = "mobility"};

    std::string molecule;
    std::optional<Motion> motion;
    std::optional<Shape> shape;

    void visit(FieldVisitor& v) {
        v.enter_table({.key = kind.key, .meaning = "as in [molecules.NAME]", .is_inline = true});
        v.text({.key = "molecule",
                .meaning = "name of a molecule",
                .required = true,
                .form = TextForm::Molecule},
               molecule);
        choose_if_set(v, {.key = "motion", .meaning = "as in [molecules.NAME]"}, motion_names,
                      motion);
        choose_if_set(v, {.key = "shape", .meaning = "as in [molecules.NAME]"}, shape_names, shape);
        v.leave_table();
    }
    void check(const std::string& key, Problems& problems) const {
        if (motion || shape) return;
        problems.add(problems.place_of(key),
                     fmt::format("'{}' changes nothing; expected motion or shape", key));
    }
    std::string undo_name() const { return format_translated("mobility of {}", molecule); }
    bool makes_mobile() const { return true; }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const MobilityEdit&, const MobilityEdit&) = default;
};

}  // namespace palpa
