#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"
#include "scene/problems.h"

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

class World;

// A spring between two atoms or residues, or from one to a place, instead of an earlier one of the
// same ends; k = 0 removes that.
struct RestraintEdit {
    static constexpr EditKind kind{.key = "restraint"};
    static constexpr double least_k = 1e-3, most_k = 1e4;  // kcal/mol/Å^2, of one that is there
    static constexpr double most_length = 1e3;             // Å

    std::vector<std::string> atoms;
    std::optional<std::array<double, 3>> place_angstrom;
    double k_kcal_per_mol_angstrom2 = 20;
    double length_angstrom = 0;

    void visit(FieldVisitor& v) {
        v.enter_table(
            {.key = kind.key, .meaning = "a spring between two, or to a place", .is_inline = true});
        visit_keys(v);
        v.leave_table();
    }
    void visit_keys(FieldVisitor& v) {
        v.texts({.key = "atoms",
                 .meaning = "one or two atoms or residues",
                 .lowest = 1,
                 .highest = 2,
                 .required = true,
                 .form = TextForm::ResidueOrAtom},
                atoms);
        triple_if_set(v,
                      {.key = "place_angstrom",
                       .meaning = "place to which the atom is pulled, Å",
                       .lowest = -farthest_angstrom,
                       .highest = farthest_angstrom},
                      place_angstrom);
        v.real({.key = "k_kcal_per_mol_angstrom2",
                .meaning = "stiffness, E = k x²/2; 0: no spring",
                .lowest = 0,
                .highest = most_k},
               k_kcal_per_mol_angstrom2);
        v.real({.key = "length_angstrom",
                .meaning = "length at rest",
                .lowest = 0,
                .highest = most_length},
               length_angstrom);
    }
    void check(const std::string& key, Problems& problems) const {
        const std::size_t ends = atoms.size() + (place_angstrom ? 1 : 0);
        if (atoms.empty() || ends == 2) return;  // without atoms it is reported already
        problems.add(problems.place_of(key),
                     fmt::format("'{}' has {} {}; expected two atoms, or one and place_angstrom",
                                 key, ends, ends == 1 ? "end" : "ends"));
    }
    std::string undo_name() const { return translated("restraint"); }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const RestraintEdit&, const RestraintEdit&) = default;
};

}  // namespace palpa
