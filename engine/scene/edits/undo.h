#pragma once
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

namespace palpa {

// The session's history goes one entry back or forth (session/undo_history.h).
struct UndoEdit {
    static constexpr EditKind kind{.key = "undo", .is_quick = true};

    void visit(FieldVisitor& v) {
        v.mark({.key = kind.key, .meaning = "undoes the last edit or grip"});
    }

    friend bool operator==(const UndoEdit&, const UndoEdit&) = default;
};
struct RedoEdit {
    static constexpr EditKind kind{.key = "redo", .is_quick = true};

    void visit(FieldVisitor& v) {
        v.mark({.key = kind.key, .meaning = "redoes the last undone edit"});
    }

    friend bool operator==(const RedoEdit&, const RedoEdit&) = default;
};

}  // namespace palpa
