// Leaves out of a picture what hides the molecule in hand.
#pragma once
#include "molecule/atoms.h"
#include "render/frame_scene.h"
#include "view/orbit_camera.h"

#include <cstdint>

namespace palpa {

// Removes the atoms of others, and the bonds at them, that stand nearer to the camera than an atom
// of the molecule in hand and within 2 Å beside it as the camera sees it, and atoms that lose all
// their bonds by that. What a hydrogen bond leads to stays, with its own bonds. Of a frame whose
// atoms are picked by their index, those of `held` are the grabbed molecule's.
void clip_in_front(const AtomRange& held, const OrbitCamera& camera, FrameScene& frame);

}  // namespace palpa
