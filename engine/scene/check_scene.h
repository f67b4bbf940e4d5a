// Checks the fields of a scene against each other.
#pragma once
#include "scene/description.h"
#include "scene/problems.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace palpa {

void check_scene(const SceneDescription& scene, Problems& problems);
void check_edits(const SceneDescription& scene, Problems& problems);
// Checks one edit of a scene with so many hands, or of a command (scene/run_commands.h). `path`:
// prefix of its keys.
void check_edit(const EditDescription& edit, std::size_t hands, const std::string& path,
                Problems& problems);
// Whether it is "HOST:PORT" with a numeric host or "localhost".
bool is_engine_address(std::string_view address);
// `table`: its place in the scene, "coupling".
void check_coupling(const std::string& table, const CouplingDescription& coupling,
                    Problems& problems);

}  // namespace palpa
