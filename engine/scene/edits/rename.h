#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>

namespace palpa {

class World;

// Gives a molecule another name, which no other molecule may have.
struct RenameEdit {
    static constexpr EditKind kind{.key = "rename", .with_engine = true, .is_quick = true};

    std::string molecule, to;

    void visit(FieldVisitor& v) {
        v.enter_table(
            {.key = kind.key, .meaning = "another name of a molecule", .is_inline = true});
        v.text({.key = "molecule",
                .meaning = "name of a molecule",
                .required = true,
                .form = TextForm::Molecule},
               molecule);
        v.text(
            {.key = "to", .meaning = "its new name", .required = true, .form = TextForm::Molecule},
            to);
        v.leave_table();
    }
    std::string undo_name() const { return format_translated("name of {}", to); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const RenameEdit&, const RenameEdit&) = default;
};

}  // namespace palpa
