// The fields of [view], a part of the list of scene/fields.h.
#pragma once
#include "scene/fields.h"

namespace palpa {

void visit_view(FieldVisitor& visitor, ViewDescription& view);

}  // namespace palpa
