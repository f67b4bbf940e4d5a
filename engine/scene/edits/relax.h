#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>

namespace palpa {

class World;

// Everything that moves by itself goes to where no force is left, as at the start; hands hold on.
struct RelaxEdit {
    static constexpr EditKind kind{.key = "relax", .is_of_molecules = false};

    void visit(FieldVisitor& v) {
        v.mark({.key = kind.key, .meaning = "everything that no hand holds comes to rest"});
    }
    std::string undo_name() const { return translated("relaxation"); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const RelaxEdit&, const RelaxEdit&) = default;
};

}  // namespace palpa
