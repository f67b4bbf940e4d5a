// The fields of [joints] and [statics], a part of the list of scene/fields.h.
#pragma once
#include "scene/fields.h"

namespace palpa {

void visit_joints(FieldVisitor& visitor, JointsDescription& joints);
void visit_statics(FieldVisitor& visitor, StaticsDescription& statics);

}  // namespace palpa
