#include "scene/edit_fields.h"

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

namespace palpa {
namespace {

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
    std::visit([&](auto& edit) { edit.visit(v); }, action);
}

void visit_edits(FieldVisitor& v, std::vector<EditDescription>& edits) {
    visit_entries(v, {.key = "edits", .meaning = "changes while the scene runs"}, edits,
                  [&](EditDescription& edit) { visit_edit(v, edit); });
}

}  // namespace palpa
