#pragma once
#include "core/translate.h"
#include "scene/edits/kind.h"
#include "scene/field_visitor.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

class World;

// Adds a molecule with its reference atom at a place: a residue of the scene's force field, a copy
// of a molecule, or what files have. The reference atom of a residue and of files is the first.
struct AddEdit {
    static constexpr EditKind kind{.key = "add"};

    std::string residue, copy_of;  // exactly one of residue, copy_of, structure
    std::string name;
    std::array<double, 3> at_angstrom{};
    // The keys of [molecules.NAME]; without segment: the only one of the file.
    std::filesystem::path structure{}, topology{};
    std::string segment{};

    void visit(FieldVisitor& v) {
        v.enter_table({.key = kind.key,
                       .meaning = "a new molecule: a residue of the force field, a copy, or files",
                       .is_inline = true});
        constexpr std::array<std::string_view, 3> origins{"residue", "copy_of", "structure"};
        const std::size_t chosen = !structure.empty() ? 2 : !copy_of.empty() ? 1 : 0;
        for (const std::size_t origin : v.one_of(origins, chosen)) {
            if (origin == 0) {
                v.text({.key = "residue",
                        .meaning = "name of a residue of the force field",
                        .required = true},
                       residue);
            } else if (origin == 1) {
                v.text(
                    {.key = "copy_of", .meaning = "name of a molecule", .form = TextForm::Molecule},
                    copy_of);
            } else {
                visit_files(v);
            }
        }
        v.text({.key = "name",
                .meaning = "name of the new molecule",
                .required = true,
                .form = TextForm::Molecule},
               name);
        v.triple({.key = "at_angstrom",
                  .meaning = "position of its reference atom, Å",
                  .lowest = -farthest_angstrom,
                  .highest = farthest_angstrom,
                  .required = true},
                 at_angstrom);
        v.leave_table();
    }
    void visit_files(FieldVisitor& v) {
        v.file({.key = "structure", .meaning = "as in [molecules.NAME]", .required = true},
               structure);
        v.file({.key = "topology", .meaning = "as in [molecules.NAME]"}, topology);
        const Field of_several{.key = "segment", .meaning = "segment, if the file has several"};
        if (v.is_there(of_several, !segment.empty())) v.text(of_several, segment);
    }
    std::string undo_name() const { return format_translated("addition of {}", name); }
    // The files that it reads.
    std::vector<std::filesystem::path*> list_files() { return {&structure, &topology}; }

    void apply(World& world, std::size_t hand) const;

    friend bool operator==(const AddEdit&, const AddEdit&) = default;
};

}  // namespace palpa
