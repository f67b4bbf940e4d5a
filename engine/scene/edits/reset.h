#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>

namespace palpa {

class World;

// Loads the scene again; the clock continues, and hands grip at the present poses of their devices.
struct ResetEdit {
    static constexpr EditKind kind{.key = "reset", .sets_coupling = true};

    void visit(FieldVisitor& v) {
        v.mark({.key = kind.key, .meaning = "resets molecules, hands and coupling to this file"});
    }
    std::string undo_name() const { return translated("reset"); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const ResetEdit&, const ResetEdit&) = default;
};

}  // namespace palpa
