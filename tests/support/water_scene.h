// The bundled water scene, with settings as --set takes them.
#pragma once
#include "scene/read_scene.h"
#include "tests/support/paths.h"

#include <string>
#include <vector>

namespace palpa::test {

inline SceneDescription water_scene(const std::vector<std::string>& settings = {}) {
    return read_scene(in_project("scenes/water"), settings);
}

}  // namespace palpa::test
