// Views that a scene saves under names: the cameras that they are seen by.
#pragma once
#include "scene/description.h"
#include "view/orbit_camera.h"

#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

// Null where there is none of that name.
const SavedView* find_saved_view(std::span<const SavedView> views, std::string_view name);

// The first of "view 1", "view 2", ... that none is called.
std::string find_free_view_name(std::span<const SavedView> views);

// Sees the atoms that `framed` names, one entry an atom, or all where it names none. `places`: Å,
// of all atoms.
OrbitCamera saved_camera(const SavedView& saved, std::span<const glm::vec3> places,
                         const std::vector<bool>& framed, const Room& room);

// Gives a view the camera and the shift by which saved_camera sees as this one does: to tenths of a
// degree, three digits of the zoom and hundredths of an Å, within what the keys take.
void set_camera(SavedView& saved, const OrbitCamera& camera, std::span<const glm::vec3> places,
                const std::vector<bool>& framed, const Room& room);

}  // namespace palpa
