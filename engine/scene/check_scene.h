// What the fields of a scene must be together, beyond what each of them says by itself.
#pragma once
#include "scene/description.h"
#include "scene/problems.h"

namespace palpa {

void check_scene(const SceneDescription& scene, Problems& problems);
void check_edits(const SceneDescription& scene, Problems& problems);
void check_coupling(const CouplingDescription& coupling, Problems& problems);

}  // namespace palpa
