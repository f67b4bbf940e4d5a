// Leaves out of a picture what hides the molecule in hand.
#pragma once
#include "render/frame_scene.h"
#include "view/orbit_camera.h"

#include <cstdint>

namespace palpa {

// Removes the atoms of others, and the bonds at them, that stand nearer to the camera than an atom
// of the molecule in hand and within 2 Å beside it as the camera sees it, and atoms that lose all
// their bonds by that. What a hydrogen bond leads to stays, with its own bonds. Of a frame whose
// atoms are picked by their index, the grabbed molecule's below `grabbed_atoms`.
void clip_in_front(std::uint32_t grabbed_atoms, const OrbitCamera& camera, FrameScene& frame);

}  // namespace palpa
