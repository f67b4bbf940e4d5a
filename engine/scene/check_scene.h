// What the fields of a scene must be together, beyond what each of them says by itself.
#pragma once
#include "scene/description.h"
#include "scene/problems.h"

#include <string>
#include <string_view>

namespace palpa {

void check_scene(const SceneDescription& scene, Problems& problems);
void check_edits(const SceneDescription& scene, Problems& problems);
// One of them, or a command's (scene/run_commands.h). `path`: what stands before its keys.
void check_edit(const EditDescription& edit, bool has_second, const std::string& path,
                Problems& problems);
// "HOST:PORT", the host in numbers or "localhost".
bool is_engine_address(std::string_view address);
void check_coupling(const CouplingDescription& coupling, Problems& problems);

}  // namespace palpa
