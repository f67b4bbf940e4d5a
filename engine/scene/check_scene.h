// Checks the fields of a scene against each other.
#pragma once
#include "scene/description.h"
#include "scene/problems.h"

#include <string>
#include <string_view>

namespace palpa {

void check_scene(const SceneDescription& scene, Problems& problems);
void check_edits(const SceneDescription& scene, Problems& problems);
// Checks one edit of a scene or of a command (scene/run_commands.h). `path`: prefix of its keys.
void check_edit(const EditDescription& edit, bool has_second, const std::string& path,
                Problems& problems);
// Whether it is "HOST:PORT" with a numeric host or "localhost".
bool is_engine_address(std::string_view address);
void check_coupling(const CouplingDescription& coupling, Problems& problems);

}  // namespace palpa
