#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>

namespace palpa {

class World;

// The hand releases what it holds.
struct ReleaseEdit {
    static constexpr EditKind kind{.key = "let_go", .with_engine = true, .is_of_molecules = false};

    void visit(FieldVisitor& v) { v.mark({.key = kind.key, .meaning = "the hand lets go"}); }
    std::string undo_name() const { return translated("letting go"); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const ReleaseEdit&, const ReleaseEdit&) = default;
};

}  // namespace palpa
