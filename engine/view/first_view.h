// How a scene is seen at first: what its [view] says, and what shows it best where that says
// nothing.
#pragma once
#include "ecs/world.h"
#include "molecule/atoms.h"
#include "scene/description.h"
#include "view/build_frame.h"
#include "view/orbit_camera.h"

#include <array>

namespace palpa {

// Unless the scene says, balls and sticks, but `pocket` where others would hide the molecule.
ViewSettings first_settings(const ViewDescription& view, const World& world);

// The atoms that the picture is to frame: a molecule's, or none where it is to frame everything.
AtomRange framed_atoms(const ViewDescription& view, const World& world);

// Sees those atoms of a frame, or everything, as the scene says.
OrbitCamera first_camera(const ViewDescription& view, const FrameScene& frame,
                         const AtomRange& framed, const Room& room);

// The `camera` of a [view] that sees the frame as this camera does, but for where it was shifted
// to: to tenths of a degree and hundredths of the zoom, within what the key takes.
std::array<double, 3> describe_camera(const OrbitCamera& camera, const ViewDescription& view,
                                      const FrameScene& frame, const AtomRange& framed,
                                      const Room& room);

}  // namespace palpa
