// Removes what hides the held molecule from a picture.
#pragma once
#include "molecule/atoms.h"
#include "render/frame_scene.h"
#include "view/orbit_camera.h"

#include <cstdint>

namespace palpa {

// Removes atoms of other molecules, with their bonds, that are nearer to the camera than an atom of
// the held molecule and within 2 Å beside it in the picture, and atoms that lose all their bonds by
// that. Partners of hydrogen bonds stay, with their own bonds. In a frame whose atoms are picked by
// index, `held` are the held molecule's atoms.
void clip_in_front(const AtomRange& held, const OrbitCamera& camera, FrameScene& frame);

}  // namespace palpa
