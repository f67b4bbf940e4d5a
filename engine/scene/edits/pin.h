#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpa {

class World;

// A measurement: of one atom a label, of two their distance, of three an angle, of four a dihedral.
// The same atoms once more remove it.
struct PinEdit {
    static constexpr EditKind kind{.key = "pin", .is_quick = true};

    std::vector<std::string> atoms;

    void visit(FieldVisitor& v) {
        v.texts({.key = kind.key,
                 .meaning = "marks atoms: label, distance, angle or dihedral",
                 .lowest = 1,
                 .highest = 4,
                 .form = TextForm::Atom},
                atoms);
    }
    std::string undo_name() const { return translated("measurement"); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const PinEdit&, const PinEdit&) = default;
};

}  // namespace palpa
