#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>

namespace palpa {

class World;

// The hand takes hold of a molecule as a whole, or of a residue or atom by a spring. It first
// releases what it held. A molecule held as a whole follows the hand; at a spring it moves by
// itself, even if it is otherwise fixed. On release it gets back its former mobility.
struct GrabEdit {
    static constexpr EditKind kind{.key = "take", .with_engine = true, .is_of_molecules = false};

    std::string what;

    void visit(FieldVisitor& v) {
        v.text({.key = kind.key,
                .meaning = "the hand takes the molecule \"NAME\", or by a spring \"NAME:25\" or "
                           "\"NAME:25 CA\"",
                .form = TextForm::MoleculeOrPart},
               what);
    }
    std::string undo_name() const { return format_translated("grip of {}", what); }
    bool makes_mobile() const { return what.find(':') != std::string::npos; }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const GrabEdit&, const GrabEdit&) = default;
};

}  // namespace palpa
