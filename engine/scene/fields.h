// The single list of all fields of a scene file, each with key, meaning and range. Reading, writing
// and documenting a scene are three visitors of it.
#pragma once
#include "scene/description.h"
#include "scene/field_visitor.h"

#include <string>
#include <vector>

namespace palpa {

void visit_scene(FieldVisitor& visitor, SceneDescription& scene);

// The keys of the table [coupling].
void visit_coupling_keys(FieldVisitor& visitor, CouplingDescription& coupling);

// For documentation and messages: every key in full ("molecules.NAME.segment") with its meaning,
// default or choices, and range.
struct FieldNote {
    std::string key, type, fallback, meaning;
};
std::vector<FieldNote> list_fields();

}  // namespace palpa
