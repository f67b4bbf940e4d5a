#include "scene/edit_fields.h"

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace palpa {
namespace {

void visit_action(FieldVisitor& v, TakeEdit& e) {
    v.text(
        {.key = "take",
         .meaning =
             "the hand takes the molecule \"NAME\", or by a spring \"NAME:25\" or \"NAME:25 CA\"",
         .form = TextForm::MoleculeOrPart},
        e.what);
}

void visit_action(FieldVisitor& v, LetGoEdit& /*e*/) {
    v.mark({.key = "let_go", .meaning = "the hand lets go"});
}

void visit_action(FieldVisitor& v, PutBackEdit& /*e*/) {
    v.mark({.key = "put_back", .meaning = "what it holds goes back to where it was at the start"});
}

void visit_action(FieldVisitor& v, AddEdit& e) {
    v.enter_table({.key = "add",
                   .meaning = "a new molecule: a residue of the force field, a copy, or files",
                   .is_inline = true});
    constexpr std::array<std::string_view, 3> origins{"residue", "copy_of", "structure"};
    const std::size_t chosen = !e.structure.empty() ? 2 : !e.copy_of.empty() ? 1 : 0;
    for (const std::size_t origin : v.one_of(origins, chosen)) {
        if (origin == 0) {
            v.text({.key = "residue",
                    .meaning = "name of a residue of the force field",
                    .required = true},
                   e.residue);
        } else if (origin == 1) {
            v.text({.key = "copy_of", .meaning = "name of a molecule", .form = TextForm::Molecule},
                   e.copy_of);
        } else {
            v.file({.key = "structure", .meaning = "as in [molecules.NAME]", .required = true},
                   e.structure);
            v.file({.key = "topology", .meaning = "as in [molecules.NAME]"}, e.topology);
            const Field segment{.key = "segment", .meaning = "segment, if the file has several"};
            if (v.is_there(segment, !e.segment.empty())) v.text(segment, e.segment);
        }
    }
    v.text({.key = "name",
            .meaning = "name of the new molecule",
            .required = true,
            .form = TextForm::Molecule},
           e.name);
    v.triple({.key = "at_angstrom",
              .meaning = "position of its reference atom, Å",
              .lowest = -farthest_angstrom,
              .highest = farthest_angstrom,
              .required = true},
             e.at_angstrom);
    v.leave_table();
}

void visit_action(FieldVisitor& v, RemoveEdit& e) {
    v.text({.key = "remove", .meaning = "removes a molecule", .form = TextForm::Molecule},
           e.molecule);
}

void visit_action(FieldVisitor& v, PinEdit& e) {
    v.texts({.key = "pin",
             .meaning = "marks atoms: label, distance, angle or dihedral",
             .lowest = 1,
             .highest = 4,
             .form = TextForm::Atom},
            e.atoms);
}

void visit_action(FieldVisitor& v, RestraintEdit& e) {
    v.enter_table(
        {.key = "restraint", .meaning = "a spring between two, or to a place", .is_inline = true});
    visit_restraint(v, e);
    v.leave_table();
}

void visit_action(FieldVisitor& v, MobilityEdit& e) {
    v.enter_table({.key = "mobility", .meaning = "as in [molecules.NAME]", .is_inline = true});
    v.text({.key = "molecule",
            .meaning = "name of a molecule",
            .required = true,
            .form = TextForm::Molecule},
           e.molecule);
    choose_if_set(v, {.key = "motion", .meaning = "as in [molecules.NAME]"}, motion_names,
                  e.motion);
    choose_if_set(v, {.key = "shape", .meaning = "as in [molecules.NAME]"}, shape_names, e.shape);
    v.leave_table();
}

void visit_action(FieldVisitor& v, AppearanceEdit& e) {
    v.enter_table({.key = "appearance", .meaning = "as in [view]", .is_inline = true});
    v.text({.key = "molecule",
            .meaning = "name of a molecule",
            .required = true,
            .form = TextForm::Molecule},
           e.molecule);
    choose_if_set(v, {.key = "representation", .meaning = "as in [view]"}, representation_names,
                  e.representation);
    choose_if_set(v, {.key = "colour", .meaning = "as in [view]"}, colouring_names, e.colouring);
    const Field visible{.key = "visible", .meaning = "whether it is drawn"};
    if (v.is_there(visible, e.visible.has_value())) {
        if (!e.visible) e.visible.emplace();
        v.flag(visible, *e.visible);
    }
    v.leave_table();
}

void visit_action(FieldVisitor& v, CouplingEdit& e) {
    v.coupling_settings({.key = "coupling", .meaning = "new values for keys of [coupling]"},
                        e.settings);
}

void visit_action(FieldVisitor& v, ResetEdit& /*e*/) {
    v.mark({.key = "reset", .meaning = "resets molecules, hands and coupling to this file"});
}

void visit_action(FieldVisitor& v, UndoEdit& /*e*/) {
    v.mark({.key = "undo", .meaning = "undoes the last edit or grip"});
}

void visit_action(FieldVisitor& v, RedoEdit& /*e*/) {
    v.mark({.key = "redo", .meaning = "redoes the last undone edit"});
}

template <std::size_t... Index>
EditAction action_of(std::size_t index, std::index_sequence<Index...> /*all*/) {
    EditAction action;
    ((index == Index ? void(action.emplace<Index>()) : void()), ...);
    return action;
}

void visit_edit(FieldVisitor& v, EditDescription& edit) {
    v.real({.key = "at_s",
            .meaning = "simulated time of the edit, s; it is made before the next step",
            .lowest = 0,
            .highest = 1e5,
            .required = true},
           edit.at_s);
    v.choice({.key = "hand", .meaning = "hand that makes the edit"}, edit_hand_names, edit.hand);
    for (const std::size_t index : v.one_of(edit_names, edit.action.index())) {
        visit_edit_action(v, index, edit.action);
    }
}

}  // namespace

void visit_restraint(FieldVisitor& v, RestraintEdit& e) {
    v.texts({.key = "atoms",
             .meaning = "one or two atoms or residues",
             .lowest = 1,
             .highest = 2,
             .required = true,
             .form = TextForm::ResidueOrAtom},
            e.atoms);
    triple_if_set(v,
                  {.key = "place_angstrom",
                   .meaning = "place to which the atom is pulled, Å",
                   .lowest = -farthest_angstrom,
                   .highest = farthest_angstrom},
                  e.place_angstrom);
    v.real({.key = "k_kcal_per_mol_angstrom2",
            .meaning = "stiffness, E = k x²/2",
            .lowest = 1e-3,
            .highest = 1e4},
           e.k_kcal_per_mol_angstrom2);
    v.real({.key = "length_angstrom", .meaning = "length at rest", .lowest = 0, .highest = 1e3},
           e.length_angstrom);
}

void visit_look(FieldVisitor& v, Appearance& a) {
    choose_if_set(v,
                  {.key = "representation",
                   .meaning = "how it is drawn, as in [view]; unset: as everything else"},
                  representation_names, a.representation);
    choose_if_set(
        v, {.key = "colour", .meaning = "its colours, as in [view]; unset: as everything else"},
        colouring_names, a.colouring);
    v.flag({.key = "visible", .meaning = "whether it is drawn"}, a.visible);
}

void visit_edit_action(FieldVisitor& v, std::size_t index, EditAction& action) {
    if (index != action.index())
        action = action_of(index, std::make_index_sequence<std::variant_size_v<EditAction>>());
    std::visit([&](auto& edit) { visit_action(v, edit); }, action);
}

void visit_edits(FieldVisitor& v, std::vector<EditDescription>& edits) {
    visit_entries(v, {.key = "edits", .meaning = "changes while the scene runs"}, edits,
                  [&](EditDescription& edit) { visit_edit(v, edit); });
}

}  // namespace palpa
