// The fields of [[edits]] and of what is like them, a part of the list of scene/fields.h.
#pragma once
#include "scene/fields.h"

#include <cstddef>
#include <vector>

namespace palpa {

void visit_look(FieldVisitor& visitor, Appearance& appearance);

void visit_edits(FieldVisitor& visitor, std::vector<EditDescription>& edits);

// The one field of an edit that says what it does, by its place in edit_names; `action` becomes
// that kind.
void visit_edit_action(FieldVisitor& visitor, std::size_t index, EditAction& action);

}  // namespace palpa
