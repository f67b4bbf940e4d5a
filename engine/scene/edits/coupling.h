#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpa {

class World;

// New values for keys of [coupling], as `--set` has them without "coupling.": "mode=3".
struct CouplingEdit {
    static constexpr EditKind kind{.key = "coupling",
                                   .with_engine = true,
                                   .is_quick = true,
                                   .sets_coupling = true,
                                   .is_of_molecules = false};

    std::vector<std::string> settings;

    void visit(FieldVisitor& v) {
        v.coupling_settings({.key = kind.key, .meaning = "new values for keys of [coupling]"},
                            settings);
    }
    std::string undo_name() const { return translated("coupling"); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const CouplingEdit&, const CouplingEdit&) = default;
};

}  // namespace palpa
