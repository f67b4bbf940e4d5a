#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>

namespace palpa {

class World;

// Removes a molecule, and what names it.
struct RemoveEdit {
    static constexpr EditKind kind{.key = "remove"};

    std::string molecule;

    void visit(FieldVisitor& v) {
        v.text({.key = kind.key, .meaning = "removes a molecule", .form = TextForm::Molecule},
               molecule);
    }
    std::string undo_name() const { return format_translated("removal of {}", molecule); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const RemoveEdit&, const RemoveEdit&) = default;
};

}  // namespace palpa
