// The named views of a scene and their cameras.
#pragma once
#include "scene/description.h"
#include "view/orbit_camera.h"

#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

// Null if there is no view of that name.
const SavedView* find_saved_view(std::span<const SavedView> views, std::string_view name);

// The first unused name of "view 1", "view 2", ...
std::string find_free_view_name(std::span<const SavedView> views);

// A camera that frames the atoms marked in `framed` (one entry per atom), or all if none is.
// `places`: Å, of all atoms.
OrbitCamera saved_camera(const SavedView& saved, std::span<const glm::vec3> places,
                         const std::vector<bool>& framed, const Room& room);

// Stores in a view the camera and the shift that reproduce this camera: to 0.1 degree, three digits
// of the zoom and 0.01 Å, within the limits of the keys.
void set_camera(SavedView& saved, const OrbitCamera& camera, std::span<const glm::vec3> places,
                const std::vector<bool>& framed, const Room& room);

}  // namespace palpa
