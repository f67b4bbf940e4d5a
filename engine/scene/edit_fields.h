// The fields of [[edits]], a part of the list of scene/fields.h.
#pragma once
#include "scene/fields.h"

#include <vector>

namespace palpa {

void visit_edits(FieldVisitor& visitor, std::vector<EditDescription>& edits);

}  // namespace palpa
