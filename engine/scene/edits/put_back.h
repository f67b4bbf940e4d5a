#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>

namespace palpa {

class World;

// The molecule that the hand holds goes back to where it was when the scene began, or when it was
// added, in the shape it had then; the hand keeps hold of it. Refused where something else is there
// now, and where another hand holds it too.
struct PutBackEdit {
    static constexpr EditKind kind{.key = "put_back", .is_of_molecules = false};

    void visit(FieldVisitor& v) {
        v.mark(
            {.key = kind.key, .meaning = "what it holds goes back to where it was at the start"});
    }
    std::string undo_name() const { return translated("return to the start"); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const PutBackEdit&, const PutBackEdit&) = default;
};

}  // namespace palpa
